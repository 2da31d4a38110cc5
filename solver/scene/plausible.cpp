#include "scene/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace strata {

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
    if (rock.youngs_modulus_Pa > 1.2e12) {
      out.push_back(fmt::format("{}youngs_modulus_Pa = {:g} is more than 1.2e12, that of diamond: 10 GPa is 10e9",
                                table, rock.youngs_modulus_Pa));
    }
    least(table + "density_kg_m3", rock.density_kg_m3, 100.0,
          "100, and pumice has 250: is it in g/cm^3? 2.5 g/cm^3 is 2500");
    least(table + "toughness_Pa_sqrt_m", rock.toughness_Pa_sqrt_m, 1e3,
          "1e3, that of soft clay: is it in MPa sqrt(m)? 1.45 MPa sqrt(m) is 1.45e6");
  }
  const InSitu& in_situ = scene.in_situ;
  constexpr const char* of_rock = "1e3, that of 4 cm of rock: is it in MPa? 3 MPa is 3e6";
  least("in_situ.vertical_Pa", in_situ.vertical_Pa, 1e3, of_rock);
  least("in_situ.horizontal_Pa", in_situ.horizontal_Pa, 1e3, of_rock);
  if (!scene.fracture) return out;
  const Fluid& fluid = scene.fluid;
  const double end_Pa = scene.stop.inlet_Pa.value_or(0.0);
  constexpr const char* of_air = "1e3, a hundredth of the air's pressure: is it in MPa? 2 MPa is 2e6";
  least("fluid.inlet.start_Pa", fluid.start_Pa, 1e3, of_air);
  least("stop.inlet_Pa", end_Pa, 1e3, of_air);
  if (fluid.law == Fluid::Law::uniform) return out;
  // The fluid's volume changes by P/M, and the laws of flow leave out the square of that: half of it at a tenth.
  least("fluid.bulk_modulus_Pa", fluid.bulk_modulus_Pa,
        10.0 * std::max({fluid.start_Pa, end_Pa, std::abs(in_situ.vertical_Pa), std::abs(in_situ.horizontal_Pa)}),
        "ten times the scene's pressures, which would change the fluid's volume by more than a tenth: is it in GPa? "
        "2.2 GPa is 2.2e9");
  // Hydrogen, the thinnest of gases, has 9e-6 Pa s.
  least("fluid.viscosity_Pa_s", fluid.viscosity_Pa_s, 1e-6, "1e-6, and no fluid is so thin: water has 1e-3 Pa s");
  return out;
}

}  // namespace strata
