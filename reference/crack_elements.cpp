#include "crack_elements.hpp"

#include <cmath>

namespace strata::reference {
namespace {

using Complex = std::complex<double>;
using Derivatives = std::array<Complex, 3>;  // H', H'', H'''

constexpr double kFar = 10.0;
constexpr int kFarTerms = 17;

// H = sum_m w^(-m-1)/(k + m + 1), tip elements with k + 1/2: for |w| > kFar.
Derivatives far_derivatives(double power, Complex w) {
  Derivatives H{};
  const Complex inverse = 1.0 / w;
  Complex term = inverse * inverse;  // w^(-m-2)
  for (int m = 0; m < kFarTerms; ++m, term *= inverse) {
    const Complex c = -(m + 1.0) * term / (power + m + 1);
    H[0] += c;
    H[1] -= (m + 2.0) * c * inverse;
    H[2] += (m + 2.0) * (m + 3.0) * c * inverse * inverse;
  }
  return H;
}

// H = w^k M - .., M = log(w/(w-1)).
std::array<Derivatives, kElementModes> inner_derivatives(Complex w, bool on_element) {
  const Complex a = 1.0 / w, b = 1.0 / (w - 1.0);
  const Complex M = on_element ? Complex(std::log(std::abs(w / (w - 1.0)))) : std::log(w / (w - 1.0));
  const Complex M_1 = a - b, M_2 = b * b - a * a, M_3 = 2.0 * (a * a * a - b * b * b);
  return {Derivatives{M_1, M_2, M_3}, Derivatives{M + w * M_1, 2.0 * M_1 + w * M_2, 3.0 * M_2 + w * M_3},
          Derivatives{2.0 * w * M + w * w * M_1 - 1.0, 2.0 * M + 4.0 * w * M_1 + w * w * M_2,
                      6.0 * M_1 + 6.0 * w * M_2 + w * w * M_3}};
}

// H = w^(k+1) S - .., S = w^(-1/2) log((w^(1/2)+1)/(w^(1/2)-1)), so S' = -S/(2w) - 1/(w(w-1)).
std::array<Derivatives, kElementModes> tip_derivatives(Complex w, bool on_element) {
  const Complex root = std::sqrt(w);
  const Complex ratio = (root + 1.0) / (root - 1.0);
  const Complex S = (on_element ? Complex(std::log(std::abs(ratio))) : std::log(ratio)) / root;
  const Complex q = w * (w - 1.0), dq = 2.0 * w - 1.0;
  const Complex S_1 = -S / (2.0 * w) - 1.0 / q;
  const Complex S_2 = -S_1 / (2.0 * w) + S / (2.0 * w * w) + dq / (q * q);
  const Complex S_3 = -S_2 / (2.0 * w) + S_1 / (w * w) - S / (w * w * w) + 2.0 / (q * q) - 2.0 * dq * dq / (q * q * q);
  const Complex w2 = w * w, w3 = w2 * w;
  return {Derivatives{S + w * S_1, 2.0 * S_1 + w * S_2, 3.0 * S_2 + w * S_3},
          Derivatives{2.0 * w * S + w2 * S_1 - 2.0, 2.0 * S + 4.0 * w * S_1 + w2 * S_2,
                      6.0 * S_1 + 6.0 * w * S_2 + w2 * S_3},
          Derivatives{3.0 * w2 * S + w3 * S_1 - 4.0 * w - 2.0 / 3.0, 6.0 * w * S + 6.0 * w2 * S_1 + w3 * S_2 - 4.0,
                      6.0 * S + 18.0 * w * S_1 + 9.0 * w2 * S_2 + w3 * S_3}};
}

// phi_0', phi_0'', omega_0', omega_0'' of a mode of strength A are A f[0], A f[1], conj(A) f[2] + A f[3],
// conj(A) f[4] + A f[5].
using Factors = std::array<Complex, 6>;

// e = e^(i direction), w as in element_sums.
Factors potentials(const CrackElement& element, Complex e, const ElementSums& F, Complex w) {
  const Complex depth(0, 2 * element.start.imag());         // z_0 - conj z_0 at the start
  const Complex deepens(0, 2 * element.length * e.imag());  // and what it gains over the element
  const Complex u = 1.0 / (e * element.length);             // 1/(z - z_0) = u/(w - s)
  const Complex G_2 = depth * F.F_2 + deepens * (w * F.F_2 - F.F_1);
  const Complex G_3 = depth * F.F_3 + deepens * (w * F.F_3 - F.F_2);
  const Complex u2 = u * u;
  return {u * F.F_1, -u2 * F.F_2, u * F.F_1, -u2 * G_2, -u2 * F.F_2, 2.0 * u2 * u * G_3};
}

}  // namespace

std::array<ElementSums, kElementModes> element_sums(bool at_tip, Complex w, bool on_element) {
  std::array<Derivatives, kElementModes> H;
  if (std::norm(w) > kFar * kFar)
    for (int k = 0; k < kElementModes; ++k) H[static_cast<std::size_t>(k)] = far_derivatives(at_tip ? k + 0.5 : k, w);
  else
    H = at_tip ? tip_derivatives(w, on_element) : inner_derivatives(w, on_element);
  std::array<ElementSums, kElementModes> sums;
  for (std::size_t k = 0; k < kElementModes; ++k) sums[k] = {H[k][0], -H[k][1], 0.5 * H[k][2]};
  return sums;
}

ElementTraction element_traction(const CrackElement& element, const BondedMirror& mirror, Complex z, double across,
                                 bool on_element) {
  const Complex e = std::polar(1.0, element.direction);
  const Complex back = std::conj(e) / element.length;
  const Complex w = on_element ? Complex(((z - element.start) * back).real()) : (z - element.start) * back;
  const Complex w_mirrored = (std::conj(z) - element.start) * back;
  const bool mirrors = mirror.Pi != 0 || mirror.La != 0;
  const auto sums = element_sums(element.at_tip, w, on_element);
  const auto sums_mirrored = mirrors ? element_sums(element.at_tip, w_mirrored, false) : sums;
  const Complex turn = std::polar(1.0, 2 * across);
  ElementTraction result;
  for (int k = 0; k < kElementModes; ++k) {
    const Factors f = potentials(element, e, sums[static_cast<std::size_t>(k)], w);
    Factors image{};
    if (mirrors) image = potentials(element, e, sums_mirrored[static_cast<std::size_t>(k)], w_mirrored);
    for (const bool slip : {false, true}) {
      // A = (i/2) e^(i direction) (slip + i opening), as in bimaterial.cpp.
      const Complex A = 0.5 * e * (slip ? Complex(0, 1) : Complex(-1, 0)), A_bar = std::conj(A);
      const Complex Phi = A * f[0] + mirror.Pi * std::conj(A_bar * image[2] + A * image[3]);
      const Complex dPhi = A * f[1] + mirror.Pi * std::conj(A_bar * image[4] + A * image[5]);
      const Complex dOmega = A_bar * f[2] + A * f[3] + mirror.La * std::conj(A * image[0]);
      const Complex traction = 2 * Phi.real() + turn * ((std::conj(z) - z) * dPhi + dOmega - Phi);
      result(0, k + (slip ? kElementModes : 0)) = traction.real();
      result(1, k + (slip ? kElementModes : 0)) = traction.imag();
    }
  }
  return result;
}

}  // namespace strata::reference
