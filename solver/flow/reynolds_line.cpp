#include "flow/reynolds_line.hpp"

#include <algorithm>
#include <limits>

namespace strata {

double storage_opening(double w) {
  return std::max(w, thinnest);
}

ReynoldsLine full_line(const Fluid& fluid, const std::vector<double>& length, std::size_t inlet, double P,
                       const Eigen::VectorXd& w, FluidBalance& balance, const Eigen::VectorXd& rise) {
  ReynoldsLine line;
  const std::size_t n = length.size();
  line.length = length;
  line.P.assign(n, std::max(P, fluid.cavitation_Pa));
  for (std::size_t k = 0; k < static_cast<std::size_t>(rise.size()); ++k)
    line.P[k] = std::max(P - rise(static_cast<Eigen::Index>(k)), fluid.cavitation_Pa);
  line.phi.assign(n, 1.0);
  line.w_rate.assign(n, 0.0);
  line.wet_s.assign(n, 0.0);
  line.leaked.assign(n, 0.0);
  line.inlet = inlet;
  line.inlet_Pa = line.P[0];
  fill_openings(fluid, w, line, balance);
  return line;
}

void fill_openings(const Fluid& fluid, const Eigen::VectorXd& w, ReynoldsLine& line, FluidBalance& balance) {
  line.w.assign(w.begin(), w.end());
  line.content.resize(line.size());
  balance = {};
  for (std::size_t k = 0; k < line.size(); ++k) {
    line.content[k] = line.phi[k] * density(fluid, line.P[k]) * storage_opening(line.w[k]) * line.length[k];
    balance.stored_at_start += line.content[k];
  }
  balance.stored = balance.stored_at_start;
}

void leave_dry(const Fluid& fluid, std::size_t cell, ReynoldsLine& line, FluidBalance& balance) {
  balance.stored_at_start -= line.content[cell];
  balance.stored = balance.stored_at_start;
  line.P[cell] = fluid.cavitation_Pa;
  line.phi[cell] = line.content[cell] = 0.0;
  line.wet_s[cell] = std::numeric_limits<double>::infinity();
}

void grow(ReynoldsLine& line, const Fluid& fluid, bool at_back, double length, double time) {
  const auto add = [at_back](std::vector<double>& values, double value) {
    values.insert(at_back ? values.end() : values.begin(), value);
  };
  add(line.length, length);
  add(line.P, fluid.cavitation_Pa);
  add(line.wet_s, time);
  for (std::vector<double>* values : {&line.phi, &line.content, &line.w, &line.w_rate, &line.leaked}) add(*values, 0.0);
  line.rates_known = false;
  if (!at_back) ++line.inlet;
}

std::vector<double> vertex_pressures(const ReynoldsLine& line) {
  std::vector<double> P(line.size() + 1);
  P.front() = line.P.front();
  P.back() = line.P.back();
  for (std::size_t k = 1; k < line.size(); ++k)
    P[k] = (line.length[k] * line.P[k - 1] + line.length[k - 1] * line.P[k]) / (line.length[k - 1] + line.length[k]);
  P[line.inlet] = line.inlet_Pa;
  return P;
}

}  // namespace strata
