#include "state/round_off.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/in_situ.hpp"
#include "state/elasticity.hpp"

namespace strata {

RoundOff round_off(const Scene& scene, const State& state) {
  constexpr double tiny = 1e-12;
  double largest = largest_in_situ(scene);
  if (scene.fracture) largest = std::max({largest, std::abs(scene.fluid.start_Pa), std::abs(state.fluid.inlet_Pa)});
  double softest = std::numeric_limits<double>::infinity(), slowest = softest;
  for (const Elasticity& rock : make_elasticities(scene))
    softest = std::min(softest, rock.E_prime), slowest = std::min(slowest, rock.c_S);
  double V = 0.0;
  for (const double V_p : state.particles.V) V += V_p;
  const double stress = tiny * largest;
  const double work = 0.5 * stress * largest * V / softest;
  return {stress, work, tiny * work, stress * V / slowest};
}

}  // namespace strata
