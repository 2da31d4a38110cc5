// A pressurised fracture that ends on, or has crossed, an interface that passes no shear but stays closed.
//
// Geometry: block |x| < width/2, 0 < y < height, symmetric about x = 0 and about its bottom y = 0, sides held in x, top
// free of net traction. The fracture x = 0, 0 < y < interface + fresh holds uniform net pressure. On the interface
// y = `interface` the normal displacement is continuous; over |x| < slipped the faces slide, with springs of
// shear_stiffness or freely, farther out they are bonded. slipped = 0: no interface at all where the rocks are equal.
// In closed form, fresh = 0, slipped to the sides, no springs: the lower block is cut through and uniformly compressed
// across, s_xx = -p, s_yy = 0; it lifts the upper one, which stays free of stress:
//   opening = p width/E', energy = p^2 width interface/(2 E'), E' of the lower rock (Hooke in plane strain).
// Springs D take D p^2 width^3/(24 E'^2) from that energy, to first order in D.
// Else by elements of high order (high_order_elements.hpp), graded geometrically to 3e-4 of the shortest length at the
// tip, at the mouth on the interface and at the end of slip: the error falls exponentially with the order (Szabo &
// Babuska 1991). K_I = sqrt(E' dU/d(fresh)), the energy's exact derivative as the elements between interface, tip
// and top stretch (Parks 1974, Int. J. Fract. 10, 487).
// Valid while the fracture is open and the interface closed: p times largest_tension() below the in-situ stress on it.
#pragma once

#include <limits>
#include <vector>

#include "high_order_elements.hpp"
#include "rock.hpp"

namespace strata::reference {

struct CutBlock {
  double width = 80;                                         // m
  double height = 80;                                        // m
  double interface = 10;                                     // its height, m
  double fresh = 0;                                          // the fracture's length beyond it, m
  double slipped = std::numeric_limits<double>::infinity();  // on each side of the fracture, m
  Rock below = {}, above = {};
  double shear_stiffness = 0;  // of the slipped part, Pa/m
  double ahead = 0;            // length beyond it over which the mean traction is asked for, m; 0: not
  double widest = 1;           // element, over width/2
};

// The block under unit net pressure; answers are linear in it, energies quadratic.
class CutBlocks {
 public:
  // Solves with elements of the given order.
  // Throws std::invalid_argument for sizes that are not positive and finite, a negative length or stiffness, an
  // interface or a tip outside the block, or an order outside [2, 16].
  // shear: forces over p on the lower face at the slipped points, and their opposites on the upper one, m.
  explicit CutBlocks(const CutBlock& block, int order = 8, const Eigen::VectorXd& shear = {});

  // U/p^2 = (1/(2 p)) int opening dy over the fracture, the stored energy of the whole width, m^2/Pa.
  double energy() const { return energy_; }
  // K_I/p of the tip, sqrt(m). Throws std::invalid_argument for a tip on a decoupled interface or between two rocks,
  // std::runtime_error where round-off leaves nothing of it.
  double K_I() const;
  // Opening over p at y, m/Pa; on the interface that of the lower rock. Zero beyond the tip and outside the block.
  double opening(double y) const;
  // Mean traction (s_yy, s_xy)/p on the interface over slipped < x < slipped + ahead: forces between the elements of
  // the two sides, exact to twice the order, but for the last element, where the field is smooth: its stress.
  // Throws std::invalid_argument without a length ahead.
  struct Traction {
    double normal, shear;
  };
  Traction mean_traction_ahead() const;
  // The largest s_yy/p on the slipped part; 0 if it is pressed everywhere.
  double largest_tension() const;

  // V/p of the whole width, m^2/Pa.
  double volume() const { return volume_; }

  // What unit pressure (first column) and a unit of each point's shear (others, per N/m) do at the slipped points:
  // slip u_x(lower) - u_x(upper), m, and the force with which the upper block pulls, N/m. Half the width.
  struct Influence {
    Eigen::MatrixXd slip, tension;
    Eigen::VectorXd x, weights;  // the points, m, and their shares of the interface, m
    double volume = 0;           // V/p without shear, whole width, m^2/Pa
  };
  static Influence influence(const CutBlock& block, int order = 8);

 private:
  struct Numbers;                                           // of the unknowns
  CutBlocks(const CutBlock& block, const LineBasis& line);  // without its solution
  struct System {
    BlockTridiagonal equations;
    std::vector<Eigen::MatrixXd> loads;
    std::vector<Eigen::MatrixXd> inside;                // displacement inside each element from that of its sides
    std::pair<Eigen::MatrixXd, Eigen::MatrixXd> lower;  // the lower block's part: above and diagonal of the interface
  };
  void set_lines();
  Numbers numbered() const;
  System assembled(const Numbers& numbers) const;
  void add_springs(const Numbers& numbers, Eigen::MatrixXd& diagonal) const;
  void solve(const Eigen::VectorXd& shear);
  Influence unit_loads() const;
  double energy_rate() const;
  Rock rock(std::size_t row) const { return row < interface_row_ ? block_.below : block_.above; }
  double h_x(std::size_t column) const { return x_[column + 1] - x_[column]; }
  double h_y(std::size_t row) const { return y_[row + 1] - y_[row]; }
  Traction traction(std::size_t column, double xi) const;

  CutBlock block_;
  LineBasis line_;
  std::vector<double> x_, y_;                    // lines between the elements
  std::size_t interface_row_ = 0, tip_row_ = 0;  // the first rows above
  std::vector<std::vector<Eigen::VectorXd>> u_;  // displacement over p of each element, by row and column, m/Pa
  double energy_ = 0, volume_ = 0;
};

// Net pressure (Pa) at which the fracture grows from `fresh` to fresh + increment at once: the energy that this
// releases at constant pressure is that of the new surface,
//   p^2 [U(fresh + increment) - U(fresh)]/p^2 = increment K_Ic^2/E' (the mean of K^2/E' over the increment is J_c).
// toughness K_Ic (Pa sqrt(m)) and E' of the upper rock. Throws as CutBlocks, and for values that are not positive.
double crossing_pressure(const CutBlock& block, double increment, double toughness, int order = 8);

}  // namespace strata::reference
