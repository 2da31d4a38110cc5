#include "scene/derived.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "scene/graded_cells.hpp"
#include "scene/in_situ.hpp"
#include "scene/keys.hpp"

namespace strata {
namespace {

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
  const double along = length2 > 0.0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

// Whether a layer between two surfaces, or one and an edge that moves freely, is thinner than 1.5 cells. A layer of one
// cell has four rows of quadratic B-splines, and two rows of particles leave one motion of these without any strain:
// the layer would be a mechanism.
bool has_thin_layer(const Scene& scene) {
  const auto& layers = scene.strata.layers;
  const auto parts = [&](std::size_t interface) { return scene.has_law(scene.strata.interfaces[interface]); };
  const bool upwards = scene.strata.upwards(), ends = scene.domain.beyond_m == 0.0;
  const bool first = ends && (upwards ? scene.domain.bottom : scene.domain.sides) == Edge::traction;
  const bool last = ends && (upwards ? scene.domain.top : scene.domain.sides) == Edge::traction;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const bool below = k > 0 ? parts(k - 1) : first, above = k + 1 < layers.size() ? parts(k) : last;
    if (below && above && layers[k].to_m - layers[k].from_m < 1.49 * scene.numerics.cell_m) return true;
  }
  return false;
}

// Cells along x (axis 0) or y (1): those of the grid or, where a slip of the finger asks for too many to be made,
// about as many. Doubles, since these may be more than an int holds.
double cells_along(const Scene& scene, std::size_t axis) {
  const double h = scene.numerics.cell_m, far = scene.numerics.far_cell_m.value_or(h);
  const double extent = scene.domain.extent_m(axis);
  double fine = 0.0;
  for (const Stretch& stretch : fine_stretches(scene, axis)) fine += stretch.to - stretch.from;
  const double about = fine / h + (extent - fine) / far;
  constexpr double most_made = 1e4;
  const std::vector<double> knots = about < most_made ? scene_knots(scene, axis) : std::vector<double>();
  return knots.empty() ? std::round(about) : static_cast<double>(knots.size()) - 4.0;
}

// Cells along all that is apart at the end: the fracture's path with the ways of its tips (one equilibrium lets none
// grow) and interfaces. How much of a bonded one fails is not known.
double parted_cells(const Scene& scene) {
  double length = 0.0;
  if (scene.fracture) {
    const auto& path = scene.fracture->path_m;
    for (std::size_t k = 1; k < path.size(); ++k)
      length += std::hypot(path[k][0] - path[k - 1][0], path[k][1] - path[k - 1][1]);
    for (const GrowthWay& way : ways_of_growth(scene)) length += scene.stop.time_s == 0.0 ? 0.0 : way.length;
  }
  const auto apart = std::ranges::count_if(
      scene.strata.interfaces, [&](const InterfacePlace& place) { return scene.laws[place.law].apart_at_start(); });
  const std::size_t axis = scene.strata.upwards() ? 0 : 1;
  return length / scene.numerics.cell_m + static_cast<double>(apart) * cells_along(scene, axis);
}

// Whether equilibria decide about growth somewhere: an interface that does something may come near a tip.
bool weighs_growth(const Scene& scene) {
  if (!scene.fracture || scene.fracture->growth == Fracture::Growth::none) return false;
  bool weighs = scene.fracture->growth == Fracture::Growth::energy;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k)
    weighs = weighs || (scene.changes_at(k) && scene.fracture->crossing == Fracture::Crossing::energy);
  return weighs;
}

// Whether a fracture's path may leave its straight line: it grows, and by the direction of the largest hoop stress.
bool may_turn(const Scene& scene) {
  return scene.fracture && scene.fracture->growth != Fracture::Growth::none &&
         scene.fracture->direction == Fracture::Direction::max_hoop;
}

}  // namespace

double segment_distance(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
  const bool b_apart = cross(a0, a1, b0) * cross(a0, a1, b1) < 0.0;
  const bool a_apart = cross(b0, b1, a0) * cross(b0, b1, a1) < 0.0;
  if (a_apart && b_apart) return 0.0;
  return std::min({distance_to_segment(a0, b0, b1), distance_to_segment(a1, b0, b1), distance_to_segment(b0, a0, a1),
                   distance_to_segment(b1, a0, a1)});
}

std::optional<std::pair<std::size_t, std::size_t>> self_contact(const std::vector<Point>& path_m, double tolerance_m) {
  for (std::size_t i = 0; i + 1 < path_m.size(); ++i) {
    for (std::size_t j = i + 1; j + 1 < path_m.size(); ++j) {
      // Neighbours share a point: they touch besides only where the later one turns back onto the earlier.
      const bool touch = j == i + 1
                             ? distance_to_segment(path_m[j + 1], path_m[i], path_m[j]) <= tolerance_m ||
                                   distance_to_segment(path_m[i], path_m[j], path_m[j + 1]) <= tolerance_m
                             : segment_distance(path_m[i], path_m[i + 1], path_m[j], path_m[j + 1]) <= tolerance_m;
      if (touch) return std::pair(i, j);
    }
  }
  return std::nullopt;
}

std::vector<Point> legs_between_interfaces(const Scene& scene, const Point& from, const Point& to) {
  // An end that stands on an interface: one that follows the rock is a millimetre or so off it (see ahead_cells).
  const double on_it = 0.1 * scene.numerics.cell_m / std::hypot(to[0] - from[0], to[1] - from[1]);
  const std::size_t axis = scene.strata.upwards() ? 1 : 0;
  std::vector<double> shares;
  const auto& layers = scene.strata.layers;
  for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
    const InterfacePlace& place = scene.strata.interfaces[k];
    if (!scene.has_law(place) && layers[k].has_stress_of(layers[k + 1])) continue;
    const double share = (place.at_m - from[axis]) / (to[axis] - from[axis]);
    if (share > on_it && share < 1.0 - on_it) shares.push_back(share);
  }
  std::ranges::sort(shares);
  std::vector<Point> ends;
  for (const double s : shares) ends.push_back({from[0] + s * (to[0] - from[0]), from[1] + s * (to[1] - from[1])});
  ends.push_back(to);
  return ends;
}

std::size_t layer_at(const Scene& scene, const Point& x) {
  const auto& layers = scene.strata.layers;
  const double along = scene.stacking(x);
  std::size_t k = 0;
  while (k + 1 < layers.size() && along >= layers[k].to_m) ++k;
  return k;
}

int points_across(const Scene& scene) {
  const int across = static_cast<int>(std::lround(std::sqrt(scene.numerics.particles_per_cell)));
  // Beside a path off the grid's lines 2 x 2 points are not enough (2.6 % in J), and the stiffness of the intact block,
  // which is factored once, must not change as points become finer.
  const bool turns = scene.numerics.mechanics == Numerics::Mechanics::quasistatic && may_turn(scene);
  const bool spline = scene.numerics.shape == Numerics::Shape::bspline2;
  return across == 2 && (turns || (spline && has_thin_layer(scene))) ? 4 : across;
}

std::vector<std::string> implausible(const Scene& scene) {
  std::vector<std::string> out;
  const auto least = [&](const std::string& key, double value, double bound, const char* than) {
    if (value != 0.0 && std::abs(value) < bound)
      out.push_back(fmt::format("{} = {:g} is less than {}", key, value, than));
  };
  for (const Rock& rock : scene.rocks) {
    const std::string table = "rock." + rock.name + '.';
    // Peat has 1e6 Pa, diamond 1.1e12; pumice 250 kg/m^3; shale and chalk 1e5 Pa sqrt(m), clay a hundredth of that.
    least(table + "youngs_modulus_Pa", rock.youngs_modulus_Pa, 1e6,
          "1e6, that of peat: is it in GPa or MPa? 10 GPa is 10e9");
    if (rock.youngs_modulus_Pa > 1.2e12)
      out.push_back(fmt::format("{}youngs_modulus_Pa = {:g} is more than 1.2e12, that of diamond: 10 GPa is 10e9",
                                table, rock.youngs_modulus_Pa));
    least(table + "density_kg_m3", rock.density_kg_m3, 100.0,
          "100, and pumice has 250: is it in g/cm^3? 2.5 g/cm^3 is 2500");
    least(table + "toughness_Pa_sqrt_m", rock.toughness_Pa_sqrt_m, 1e3,
          "1e3, that of soft clay: is it in MPa sqrt(m)? 1.45 MPa sqrt(m) is 1.45e6");
  }
  const InSitu& in_situ = scene.in_situ;
  constexpr const char* of_rock = "1e3, that of 4 cm of rock: is it in MPa? 3 MPa is 3e6";
  least("in_situ.vertical_Pa", in_situ.vertical_Pa.number, 1e3, of_rock);
  least("in_situ.horizontal_Pa", in_situ.horizontal_Pa.number, 1e3, of_rock);
  for (std::size_t k = 0; k < scene.strata.layers.size(); ++k) {
    const auto& [of, own] = scene.strata.upwards() ? std::pair("horizontal", scene.strata.layers[k].horizontal_Pa)
                                                   : std::pair("vertical", scene.strata.layers[k].vertical_Pa);
    if (own) least(fmt::format("strata.layers[{}].{}_Pa", k, of), own->number, 1e3, of_rock);
  }
  if (!scene.fracture) return out;
  const Fluid& fluid = scene.fluid;
  const double end_Pa = scene.stop.inlet_Pa.value_or(0.0);
  constexpr const char* of_air = "1e3, a hundredth of the air's pressure: is it in MPa? 2 MPa is 2e6";
  least("fluid.inlet.start_Pa", fluid.start_Pa, 1e3, of_air);
  least("stop.inlet_Pa", end_Pa, 1e3, of_air);
  if (fluid.law == Fluid::Law::uniform) return out;
  // The fluid's volume changes by P/M, and the laws of flow leave out the square of that: half of it at a tenth.
  least("fluid.bulk_modulus_Pa", fluid.bulk_modulus_Pa,
        10.0 * std::max({fluid.start_Pa, end_Pa, largest_in_situ(scene)}),
        "ten times the scene's pressures, which would change the fluid's volume by more than a tenth: is it in GPa? "
        "2.2 GPa is 2.2e9");
  // Fluids open rock by a millimetre, foams in soft rock by a centimetre or two.
  if (fluid.minimum_opening_m > 0.05)
    out.push_back(fmt::format(
        "fluid.minimum_opening_m = {:g} is more than 0.05, and fluid hardly opens a fracture so far: closed faces then "
        "conduct as open ones; is it in mm? 0.1 mm is 1e-4",
        fluid.minimum_opening_m));
  // Hydrogen, the thinnest of gases, has 9e-6 Pa s.
  least("fluid.viscosity_Pa_s", fluid.viscosity_Pa_s, 1e-6, "1e-6, and no fluid is so thin: water has 1e-3 Pa s");
  return out;
}

std::optional<double> expected_duration(const Scene& scene) {
  std::optional<double> duration = scene.stop.time_s;
  if (scene.fracture && scene.stop.inlet_Pa && scene.fluid.rate_Pa_s > 0.0) {
    const double ramp = (*scene.stop.inlet_Pa - scene.fluid.start_Pa) / scene.fluid.rate_Pa_s;
    duration = std::min(ramp, duration.value_or(ramp));
  }
  return duration;
}

double points_of(const Scene& scene) {
  return cells_along(scene, 0) * cells_along(scene, 1) * std::pow(points_across(scene), 2);
}

double memory_need(const Scene& scene) {
  const double points = points_of(scene);
  const bool inertia = scene.numerics.mechanics != Numerics::Mechanics::quasistatic;
  const double moving = 21e6 + (inertia ? 1250.0 * points : 0.0);
  if (inertia && !weighs_growth(scene)) return moving;
  const double solved = mirror_symmetric(scene) && !inertia ? 0.5 : 1.0;  // of the block
  const double n = 2.0 * (solved * cells_along(scene, 0) + 1.0) * (cells_along(scene, 1) + 1.0);
  const double jumps = 6.0 * solved * parted_cells(scene);
  return moving + 800.0 * points + 500.0 * n * std::log2(n) + 56.0 * jumps * jumps;
}

std::string announce(const Scene& scene) {
  const bool held = scene.fracture && scene.domain.sides == Edge::fixed && scene.domain.beyond_m == 0.0;
  const std::vector<std::string> odd = implausible(scene);
  return fmt::format("mechanics = {}, {}{}{}; {:.2g} points, {:.2g} GB by estimate{}{}",
                     word_of(scene.numerics.mechanics),
                     scene.fracture ? "fluid.law = " + word_of(scene.fluid.law) : "no fracture",
                     scene.domain.bottom == Edge::symmetry ? ", y = 0 is a mirror (domain.bottom)" : "",
                     held ? ", sides are held (domain.beyond_m goes on)" : "", points_of(scene),
                     1e-9 * memory_need(scene), odd.empty() ? "" : "; implausible: ", fmt::join(odd, "; "));
}

std::optional<std::string> too_large(const Scene& scene, double available) {
  const double need = memory_need(scene);
  if (need <= available) return std::nullopt;
  return fmt::format(
      "too large for this machine: about {:.2g} cells of numerics.cell_m = {} m need about {:.3g} GB, and {:.3g} GB "
      "are available. Use larger cells, or grade them with numerics.far_cell_m.",
      cells_along(scene, 0) * cells_along(scene, 1), scene.numerics.cell_m, 1e-9 * need, 1e-9 * available);
}

double bytes_by_system(const char* file, std::string_view name, double otherwise) {
  std::ifstream in(file);
  for (std::string word; in >> word;) {
    double kibibytes = 0.0;
    if (word == name && in >> kibibytes) return 1024.0 * kibibytes;
  }
  return otherwise;
}

double available_memory() {
  return bytes_by_system("/proc/meminfo", "MemAvailable:", std::numeric_limits<double>::infinity());
}

}  // namespace strata
