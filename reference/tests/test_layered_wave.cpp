// Waves in columns: d'Alembert's solution, reflection at borders and springs, limits, energy, the equation itself.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "layered_wave.hpp"
#include "quadrature.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {

constexpr auto held = WaveEnd::held, loose = WaveEnd::free;
constexpr auto gaussian = VelocityPulse::Form::gaussian, cosine = VelocityPulse::Form::cosine_squared;
const WaveLayer stiff{60, 10e9 * 0.8 / (1.2 * 0.6), 2500};
const WaveLayer soft{60, 5e9 * 0.8 / (1.2 * 0.6), 2400};

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

// int_0^z exp(-q^2) dq.
double half_bell(double z) {
  return 0.5 * std::sqrt(pi) * std::erf(z);
}

// Kinetic, stored and spring energy at a time by quadrature of u, v and s; springs at the borders.
double energy_at(const LayeredWave& wave, const std::vector<WaveLayer>& layers, const std::vector<double>& springs,
                 double t) {
  double from = 0, sum = 0;
  for (std::size_t j = 0; j < layers.size(); ++j) {
    const double to = from + layers[j].thickness;
    constexpr int panels = 400;  // Simpson's rule
    for (int k = 0; k <= 2 * panels; ++k) {
      const WaveAt at = wave.at(std::min(from + layers[j].thickness * k / (2.0 * panels), to - 1e-9), t);
      const double density = 0.5 * layers[j].density * at.v * at.v + 0.5 * at.stress * at.stress / layers[j].modulus;
      const double weight = k == 0 || k == 2 * panels ? 1 : k % 2 == 1 ? 4 : 2;
      sum += density * weight * layers[j].thickness / (6.0 * panels);
    }
    if (j + 1 < layers.size()) sum += 0.5 * std::pow(wave.at(to, t).stress, 2) / springs[j];
    from = to;
  }
  return sum;
}

}  // namespace

TEST_CASE("one rock: d'Alembert's two halves, and their images beyond the ends") {
  const double c = stiff.speed(), b = 3, t = 5e-3;
  REQUIRE(c == near(2108.185, 1e-6));
  const LayeredWave wave({stiff}, {}, held, loose, {gaussian, 25, b, 0.2});
  CHECK(wave.error() < 1e-9);
  for (const double y : {12.0, 14.0, 25.0, 34.0, 37.1}) {
    const double ahead = (y - 25 - c * t) / b, behind = (y - 25 + c * t) / b;
    const WaveAt at = wave.at(y, t);
    CHECK(at.v == Approx(0.1 * (std::exp(-ahead * ahead) + std::exp(-behind * behind))).margin(1e-12));
    CHECK(at.u == Approx(0.1 * b / c * (half_bell(behind) - half_bell(ahead))).margin(1e-14));
    CHECK(at.stress ==
          Approx(0.1 * stiff.impedance() * (std::exp(-behind * behind) - std::exp(-ahead * ahead))).margin(1e-5));
  }
  // After both ends: held turns v round, free does not. Half of the pulse from each, seen at 25 m + what they
  // travelled.
  const double back = 50 / c;  // downwards 25 m, upwards 25 m
  CHECK(wave.at(25, back).v == near(-0.1, 1e-9));
  CHECK(wave.at(45, 50 / c).v == near(0.1, 1e-9));  // upwards 35 m, turned, downwards 15 m
  const LayeredWave other({stiff}, {}, loose, held, {gaussian, 25, b, 0.2});
  CHECK(other.at(25, back).v == near(0.1, 1e-9));
  CHECK(other.at(45, 50 / c).v == near(-0.1, 1e-9));
}

TEST_CASE("one rock: frequencies of its modes, none missing") {
  const double first = pi * stiff.speed() / 60;
  const VelocityPulse pulse{gaussian, 25, 3, 1};
  const LayeredWave hh({stiff}, {}, held, held, pulse), hf({stiff}, {}, held, loose, pulse),
      ff({stiff}, {}, loose, loose, pulse);
  for (std::size_t n = 0; n < 200; ++n) {
    CHECK(hh.angular_frequencies()[n] == near(first * (double(n) + 1), 1e-12));
    CHECK(hf.angular_frequencies()[n] == near(first * (double(n) + 0.5), 1e-12));
    CHECK(ff.angular_frequencies()[n] == Approx(first * double(n)).epsilon(1e-12));
  }
}

TEST_CASE("a pulse of cosine squared, to what its modes leave out") {
  const double c = stiff.speed(), b = 4, t = 8e-3;
  const VelocityPulse pulse{cosine, 30, b, 1};
  const LayeredWave wave({stiff}, {}, held, held, pulse);
  for (const double y : {12.0, 13.5, 16.9, 30.0, 45.0, 47.3, 55.0}) {
    const double exact = 0.5 * (pulse(y - c * t) + pulse(y + c * t));
    CHECK(std::abs(wave.at(y, t).v - exact) < wave.error());
  }
  CHECK(wave.error() < 1e-4);
}

TEST_CASE("a border of two rocks reflects (Z1 - Z2)/(Z1 + Z2) and lets 2 Z1/(Z1 + Z2) of the velocity through") {
  const double Z1 = stiff.impedance(), Z2 = soft.impedance(), b = 3;
  const LayeredWave wave({stiff, soft}, {1e30}, held, held, {gaussian, 35, b, 2});
  const double t1 = 25 / stiff.speed(), t2 = 20 / soft.speed();
  CHECK(wave.at(80, t1 + t2).v == near(2 * Z1 / (Z1 + Z2), 1e-7));
  CHECK(wave.at(80, t1 + t2).stress == near(-Z2 * 2 * Z1 / (Z1 + Z2), 1e-7));
  const double t3 = 20 / stiff.speed();  // back downwards, while the held end has turned the other half upwards to 25 m
  CHECK(wave.at(40, t1 + t3).v == near((Z1 - Z2) / (Z1 + Z2), 1e-7));
  CHECK(wave.at(40, t1 + t3).stress == near(Z1 * (Z1 - Z2) / (Z1 + Z2), 1e-7));
}

TEST_CASE("a spring lets a wave through with its exponential memory") {
  // Half-spaces: (Z2/D) dv/dt + (1 + Z2/Z1) v = 2 v_i at the border, v the velocity behind it.
  const double Z1 = stiff.impedance(), Z2 = soft.impedance(), b = 4, D = 1.5e9;
  const LayeredWave wave({stiff, soft}, {D}, held, held, {gaussian, 30, b, 2});
  CHECK(wave.error() < 1e-5);
  const double rate = D / Z2 * (1 + Z2 / Z1), c = stiff.speed();
  const auto incident = [&](double t) { return std::exp(-std::pow((60 - 30 - c * t) / b, 2)); };
  for (const double t : {0.012, 0.0145, 0.016, 0.019}) {
    const auto kernel = [&](double s) { return 2 * D / Z2 * incident(s) * std::exp(-rate * (t - s)); };
    const double through = integrate(kernel, 0, t, {30 / c}, 1e-11).value;
    const double y = 75, later = t + (y - 60) / soft.speed();
    CHECK(wave.at(y, later).v == Approx(through).margin(1e-6));
    // the reflected one: v_r = v_i - Z2 v/Z1
    const double below = 50, seen = t + (60 - below) / c;
    const double passing = std::exp(-std::pow((below - 30 - c * seen) / b, 2));
    CHECK(wave.at(below, seen).v == Approx(incident(t) - Z2 / Z1 * through + passing).margin(1e-6));
  }
}

TEST_CASE("springs: stiff ones bond, weak ones part, none is a free end") {
  const VelocityPulse pulse{gaussian, 40, 3, 1};
  const LayeredWave bonded({stiff, soft}, {1e30}, held, loose, pulse), firm({stiff, soft}, {1e15}, held, loose, pulse);
  const LayeredWave apart({stiff, soft}, {0}, held, loose, pulse), weak({stiff, soft}, {100}, held, loose, pulse);
  const LayeredWave alone({stiff}, {}, held, loose, pulse);
  for (const double t : {0.005, 0.02, 0.04})
    for (const double y : {5.0, 33.0, 58.0, 71.0, 110.0}) {
      CHECK(firm.at(y, t).v == Approx(bonded.at(y, t).v).margin(1e-4));
      CHECK(weak.at(y, t).v == Approx(apart.at(y, t).v).margin(1e-6));
      CHECK(apart.at(y, t).v == Approx(y < 60 ? alone.at(y, t).v : 0.0).margin(1e-6));
    }
  CHECK(weak.error() < 1e-6);
  CHECK(apart.angular_frequencies().front() == 0);  // the upper layer flies
  CHECK(weak.angular_frequencies().front() == near(std::sqrt(100 / (60 * 2400.0)), 1e-6));
}

TEST_CASE("a layer between the same rock is no layer, and ends that nothing holds keep their momentum") {
  const VelocityPulse pulse{gaussian, 33, 3, 1};
  WaveLayer part = stiff;
  part.thickness = 20;
  const LayeredWave one({stiff}, {}, loose, loose, pulse), three({part, part, part}, {1e30, 1e30}, loose, loose, pulse);
  for (const double y : {1.0, 20.0, 30.0, 59.0}) CHECK(three.at(y, 0.03).u == Approx(one.at(y, 0.03).u).margin(1e-12));
  const auto momentum = [&](double t) {
    return integrate([&](double y) { return 2500 * one.at(y, t).v; }, 0, 60, {}, 1e-9).value;
  };
  CHECK(momentum(0.031) == near(2500 * 3 * std::sqrt(pi), 1e-8));
  CHECK(energy_at(one, {stiff}, {}, 0.031) == near(one.energy(), 1e-6));
  CHECK(one.at(33, 66 / stiff.speed()).v == near(0.5, 1e-6));  // the lower half, turned at the bottom
}

TEST_CASE("energy is conserved and split between kinetic, stored and springs") {
  const std::vector<WaveLayer> layers{{10, stiff.modulus, 2500}, {7, soft.modulus, 2400}, {13, stiff.modulus, 2600}};
  const std::vector<double> springs{2e9, 8e9};
  const LayeredWave wave(layers, springs, held, loose, {gaussian, 4.5, 0.7, 1});
  CHECK(wave.energy() == near(0.5 * 2500 * 0.7 * std::sqrt(pi / 2), 1e-8));
  for (const double t : {1e-3, 5e-3, 0.0171}) CHECK(energy_at(wave, layers, springs, t) == near(wave.energy(), 1e-6));
}

TEST_CASE("the sum solves rho u_tt = s_y with s = M u_y, and each mode the boundary conditions") {
  const std::vector<WaveLayer> layers{{10, stiff.modulus, 2500}, {7, soft.modulus, 2400}};
  const LayeredWave wave(layers, {2e9}, held, loose, {gaussian, 5, 0.7, 1});
  const double t = 8.3e-3, d = 0.01, dt = d / stiff.speed();
  for (const double y : {2.1, 7.7, 12.4, 16.2}) {
    const WaveLayer& layer = layers[y < 10 ? 0 : 1];
    const auto fourth = [](double m2, double m1, double p1, double p2, double h) {
      return (m2 - 8 * m1 + 8 * p1 - p2) / (12 * h);
    };
    const auto along = [&](auto pick) {
      return fourth(pick(wave.at(y - 2 * d, t)), pick(wave.at(y - d, t)), pick(wave.at(y + d, t)),
                    pick(wave.at(y + 2 * d, t)), d);
    };
    const auto later = [&](auto pick) {
      return fourth(pick(wave.at(y, t - 2 * dt)), pick(wave.at(y, t - dt)), pick(wave.at(y, t + dt)),
                    pick(wave.at(y, t + 2 * dt)), dt);
    };
    const auto u = [](const WaveAt& at) { return at.u; };
    const auto v = [](const WaveAt& at) { return at.v; };
    const auto s = [](const WaveAt& at) { return at.stress; };
    const double Z = layer.impedance(), small = 1e-5;
    CHECK(std::abs(wave.at(y, t).stress - layer.modulus * along(u)) < small * Z);
    CHECK(std::abs(wave.at(y, t).v - later(u)) < small);
    CHECK(std::abs(layer.density * later(v) - along(s)) < small * layer.density * stiff.speed() / 0.7);
  }
  CHECK(std::abs(wave.at(0, t).u) < 1e-15);
  CHECK(std::abs(wave.at(17, t).stress) < 1e-4);
  CHECK(wave.at(10, t).u - wave.at(10 - 1e-12, t).u == Approx(wave.at(10, t).stress / 2e9).epsilon(1e-6));
}

TEST_CASE("lateral inertia: rho (u_tt - r^2 u_yytt) = M u_yy, and the speed of long waves in a plate") {
  WaveLayer bar{60, 10e9 / 0.96, 2500, 0.3};
  const LayeredWave wave({bar}, {}, held, loose, {gaussian, 25, 2, 1});
  const double t = 8.3e-3, d = 0.05, dt = d / bar.speed();
  for (const double y : {7.3, 11.7, 41.0}) {
    const auto second = [](double m2, double m1, double p0, double p1, double p2, double h) {
      return (-m2 + 16 * m1 - 30 * p0 + 16 * p1 - p2) / (12 * h * h);
    };
    const auto a = [&](double at) {
      const auto u = [&](int k) { return wave.at(at, t + k * dt).u; };
      return second(u(-2), u(-1), u(0), u(1), u(2), dt);
    };
    const auto u = [&](int k) { return wave.at(y + k * d, t).u; };
    const double u_yy = second(u(-2), u(-1), u(0), u(1), u(2), d);
    const double a_yy = second(a(y - 2 * d), a(y - d), a(y), a(y + d), a(y + 2 * d), d);
    const double size = bar.speed() / 2;  // of u_tt, V c/b
    CHECK(std::abs(a(y) - 0.09 * a_yy - bar.speed() * bar.speed() * u_yy) < 1e-3 * size);
    CHECK(std::abs(0.09 * a_yy) < size);
    // the mean stress moves the bar: rho u_tt = s_y
    const auto s = [&](int k) { return wave.at(y + k * d, t).stress; };
    CHECK(std::abs(2500 * a(y) - (s(-2) - 8 * s(-1) + 8 * s(1) - s(2)) / (12 * d)) < 1e-3 * 2500 * size);
  }
  // Long symmetric waves in a plate of half-width d (Rayleigh and Lamb): c = sqrt(E'/rho) [1 - (nu/(1-nu))^2 (k
  // d)^2/6].
  const double half = 0.5, nu = 0.2, r = nu / (1 - nu) * half / std::sqrt(3.0), k = 0.02;
  const double E = 10e9, mu = E / 2.4, c_P = std::sqrt(10e9 * 0.8 / (1.2 * 0.6) / 2500), c_S = std::sqrt(mu / 2500);
  const double c = std::sqrt(E / 0.96 / 2500) / std::sqrt(1 + r * r * k * k);
  const double p = k * std::sqrt(1 - c * c / (c_P * c_P)), q = k * std::sqrt(c * c / (c_S * c_S) - 1);
  // tan(q d)/tan(i p d) form: tan(q d)/tanh(p d) = 4 k^2 p q/(q^2 - k^2)^2 for c_S < c < c_P
  CHECK(std::tan(q * half) / std::tanh(p * half) == near(4 * k * k * p * q / std::pow(q * q - k * k, 2), 2e-8));
}

TEST_CASE("columns that cannot be meant are refused") {
  const VelocityPulse pulse{gaussian, 4.5, 0.7, 1};
  CHECK_THROWS_AS(LayeredWave({}, {}, held, held, pulse), std::invalid_argument);
  CHECK_THROWS_AS(LayeredWave({stiff, soft}, {}, held, held, pulse), std::invalid_argument);
  CHECK_THROWS_AS(LayeredWave({stiff, soft}, {-1}, held, held, pulse), std::invalid_argument);
  CHECK_THROWS_AS(LayeredWave({stiff}, {}, held, held, {gaussian, 4.5, 0, 1}), std::invalid_argument);
  CHECK_THROWS_AS(LayeredWave({{1, 1, 1, 1}, {1, 1, 1, 1}}, {1}, held, held, pulse), std::invalid_argument);
  CHECK_THROWS_AS(LayeredWave({stiff}, {}, held, held, pulse).at(61, 0), std::invalid_argument);
}
