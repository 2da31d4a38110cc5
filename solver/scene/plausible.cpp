#include "scene/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace strata {
namespace {

using Sentences = std::vector<std::string>;

void require_at_least(const std::string& key, double value, double least, const char* than, Sentences& out) {
  if (value == 0.0 || std::abs(value) >= least) return;
  out.push_back(fmt::format("{} = {:g} is less than {}", key, value, than));
}

void look_at_rock(const Rock& rock, Sentences& out) {
  const auto key = [&](const char* name) { return "rock." + rock.name + "." + name; };
  // Peat has 1e6 Pa, diamond 1.1e12; pumice 250 kg/m^3; shale and chalk 1e5 Pa sqrt(m), clay a hundredth of that.
  require_at_least(key("youngs_modulus_Pa"), rock.youngs_modulus_Pa, 1e6,
                   "1e6, that of peat: is it in GPa or MPa? 10 GPa is 10e9", out);
  if (rock.youngs_modulus_Pa > 1.2e12) {
    out.push_back(fmt::format("{} = {:g} is more than 1.2e12, that of diamond: 10 GPa is 10e9",
                              key("youngs_modulus_Pa"), rock.youngs_modulus_Pa));
  }
  require_at_least(key("density_kg_m3"), rock.density_kg_m3, 100.0,
                   "100, and pumice has 250: is it in g/cm^3? 2.5 g/cm^3 is 2500", out);
  require_at_least(key("toughness_Pa_sqrt_m"), rock.toughness_Pa_sqrt_m, 1e3,
                   "1e3, that of soft clay: is it in MPa sqrt(m)? 1.45 MPa sqrt(m) is 1.45e6", out);
}

void look_at_fluid(const Scene& scene, Sentences& out) {
  const Fluid& fluid = scene.fluid;
  constexpr const char* than = "1e3, a hundredth of the air's pressure: is it in MPa? 2 MPa is 2e6";
  require_at_least("fluid.inlet.start_Pa", fluid.start_Pa, 1e3, than, out);
  require_at_least("stop.inlet_Pa", scene.stop.inlet_Pa.value_or(0.0), 1e3, than, out);
  if (fluid.law == Fluid::Law::uniform) return;
  // The fluid's volume changes by P/M, and the laws of flow leave out the square of that: half of it at a tenth.
  const double pressure = std::max({fluid.start_Pa, scene.stop.inlet_Pa.value_or(0.0),
                                    std::abs(scene.in_situ.vertical_Pa), std::abs(scene.in_situ.horizontal_Pa)});
  require_at_least(
      "fluid.bulk_modulus_Pa", fluid.bulk_modulus_Pa, 10.0 * pressure,
      "ten times the scene's pressures, which would change the fluid's volume by more than a tenth: is it in "
      "GPa? 2.2 GPa is 2.2e9",
      out);
  // Hydrogen, the thinnest of gases, has 9e-6 Pa s.
  require_at_least("fluid.viscosity_Pa_s", fluid.viscosity_Pa_s, 1e-6,
                   "1e-6, and no fluid is so thin: water has 1e-3 Pa s", out);
}

}  // namespace

std::vector<std::string> implausible(const Scene& scene) {
  Sentences out;
  for (const Rock& rock : scene.rocks) look_at_rock(rock, out);
  constexpr const char* than = "1e3, that of 4 cm of rock: is it in MPa? 3 MPa is 3e6";
  require_at_least("in_situ.vertical_Pa", scene.in_situ.vertical_Pa, 1e3, than, out);
  require_at_least("in_situ.horizontal_Pa", scene.in_situ.horizontal_Pa, 1e3, than, out);
  if (scene.fracture) look_at_fluid(scene, out);
  return out;
}

}  // namespace strata
