// Adaptive quadrature: a thin layer over GSL that throws instead of aborting.
#pragma once

#include <functional>
#include <vector>

namespace strata::reference {

using Function = std::function<double(double)>;

struct Integral {
  double value = 0.0;
  double error = 0.0;  // GSL's absolute error estimate
};

// Integrates f over [from, to] by adaptive Gauss-Kronrod quadrature with extrapolation (GSL QAGP):
//   value = int_from^to f(s) ds.
// `breaks` are points inside the interval where f has a kink, a jump or an integrable singularity (any order; points
// outside are ignored). `relative` is the wanted relative error.
// Throws std::runtime_error if the wanted accuracy is missed by more than a factor 1000.
Integral integrate(const Function& f, double from, double to, const std::vector<double>& breaks = {},
                   double relative = 1e-12);

}  // namespace strata::reference
