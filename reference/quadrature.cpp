#include "quadrature.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <sstream>
#include <stdexcept>

namespace strata::reference {
namespace {

constexpr std::size_t kMaxIntervals = 2000;

// GSL aborts on an error by default; for the life of this object it returns the error code instead.
class QuietGsl {
 public:
  QuietGsl() : old_(gsl_set_error_handler_off()) {}
  ~QuietGsl() { gsl_set_error_handler(old_); }
  QuietGsl(const QuietGsl&) = delete;
  QuietGsl& operator=(const QuietGsl&) = delete;

 private:
  gsl_error_handler_t* old_;
};

// An exception must not cross GSL's C frames, so the first one is kept and thrown again after the call.
struct Guarded {
  const Function* f;
  std::exception_ptr thrown;
};

double evaluate(double s, void* data) {
  auto& guarded = *static_cast<Guarded*>(data);
  try {
    return guarded.thrown ? 0.0 : (*guarded.f)(s);
  } catch (...) {
    guarded.thrown = std::current_exception();
    return 0.0;
  }
}

[[noreturn]] void fail(const Integral& result) {
  std::ostringstream text;
  text << "quadrature missed its accuracy: error " << result.error << " in " << result.value;
  throw std::runtime_error(text.str());
}

}  // namespace

Integral integrate(const Function& f, double from, double to, const std::vector<double>& breaks, double relative) {
  if (from == to) return {};
  const QuietGsl quiet;
  std::vector<double> points{from};
  for (double b : breaks)
    if (b > std::min(from, to) && b < std::max(from, to)) points.push_back(b);
  points.push_back(to);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());

  const std::unique_ptr<gsl_integration_workspace, void (*)(gsl_integration_workspace*)> work(
      gsl_integration_workspace_alloc(kMaxIntervals), gsl_integration_workspace_free);
  Guarded guarded{&f, nullptr};
  gsl_function function{&evaluate, &guarded};
  Integral result;
  gsl_integration_qagp(&function, points.data(), points.size(), 0.0, relative, kMaxIntervals, work.get(), &result.value,
                       &result.error);
  if (guarded.thrown) std::rethrow_exception(guarded.thrown);

  // GSL also complains where round-off stops it just short of the wanted error, or where the value is zero; what counts
  // is the error against the size of the integrand.
  double scale = std::abs(result.value);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double middle = 0.5 * (points[i] + points[i + 1]);
    scale = std::max(scale, std::abs(f(middle)) * (points[i + 1] - points[i]));
  }
  if (!std::isfinite(result.value) || result.error > 1000 * relative * scale) fail(result);
  if (from > to) result.value = -result.value;
  return result;
}

}  // namespace strata::reference
