// Crack along any path of straight pieces (straight, kinked, or a curve given by enough points), in one rock, in the
// infinite plane or beside a bonded straight interface to another rock.
//
// On the crack the traction sent by its own jump and by the interface (crack_elements.hpp) undoes the load:
//   traction[jump](x) = -(p(x), q(x)),
// p the net pressure (fluid minus closing stress), q the shear stress that is there without the crack. Pieces are cut
// into elements of quadratic jump, those at the tips r^(1/2) (c_0 + c_1 r + c_2 r^2); both equations hold at the three
// Gauss points of each. K_I, K_II = (E'/8) sqrt(2 pi) c_0. No dislocation is left over: the jump closes at the tips.
// Frame: the interface is the line x = interface_x; the crack may be half of one with its mirror image in y = 0.
// Sources: Suo 1989 (as bimaterial.hpp); Crawford & Curran 1982, Int. J. Rock Mech. Min. Sci. 19, 1 (jumps of higher
// order); tip elements: Crouch & Starfield 1983, Boundary element methods in solid mechanics.
// Valid while the crack is open and clear of the interface. Between elements the tractions are not those asked for; the
// error of K with the given mesh is below 1e-4 for distances to the interface above about a/100 (see error()).
#pragma once

#include <complex>
#include <functional>
#include <optional>
#include <vector>

#include "crack_elements.hpp"
#include "crack_line.hpp"
#include "rock.hpp"

namespace strata::reference {

using Point = std::complex<double>;  // x + i y, m

// What surrounds the crack.
struct CrackPlane {
  Rock rock;                   // around the crack
  std::optional<Rock> beyond;  // the rock past the interface, none: the rock fills the plane
  double interface_x = 0.0;    // m; the crack lies wholly on one side
  bool mirrored = false;       // the crack's image (x, -y) is there as well; a path that starts at y = 0 joins it
};

// (p, q) in Pa at s (m along the path), where the path's direction is `along` (rad).
using PathLoad = std::function<Eigen::Vector2d(double s, double along)>;

// Fluid pressure P(s) (Pa) in a rock under in-situ stress s_xx, s_yy (Pa, tension positive): with normal n and tangent
// t of the path p = P + n.s.n, q = n.s.t.
PathLoad in_situ_load(std::function<double(double)> P, double s_xx, double s_yy);

class CurvedCrack {
 public:
  // `path` has at least two points; elements are `refine` times finer than by default.
  // Throws std::invalid_argument for points that coincide, a path that doubles back, reaches the interface, or
  // (mirrored) leaves y >= 0 or comes back to it, rocks as BondedCrack, refine < 1.
  CurvedCrack(std::vector<Point> path, const CrackPlane& plane, int refine = 1);

  struct Solution {
    Eigen::VectorXd modes;         // m, of all elements
    CrackLine::Intensities first;  // at the path's first point, 0 if it is on the symmetry line
    CrackLine::Intensities last;   // K_II > 0 turns the tip clockwise, as in CrackLine; Pa sqrt(m)
  };
  // Throws std::runtime_error if the solution is not finite.
  Solution solve(const PathLoad& load) const;

  // Opening and slip at s (m along the path).
  Eigen::Vector2d jump(const Solution& solution, double s) const;
  // Normal and shear traction (Pa) that the crack adds at z (m) off the crack, across a line of direction `across`
  // (rad); on the crack at place s with crack_traction.
  Eigen::Vector2d traction(const Solution& solution, Point z, double across) const;
  Eigen::Vector2d crack_traction(const Solution& solution, double s) const;
  // int opening ds along the path (without its mirror image), m^2.
  double volume(const Solution& solution) const;

  double length() const { return length_; }
  int elements() const { return static_cast<int>(elements_.size()); }
  const std::vector<Point>& path() const { return path_; }
  // Direction of the path's last piece, rad.
  double end_direction() const { return std::arg(path_.back() - path_[path_.size() - 2]); }

  // Largest change of K at the ends, over the size of K there, from elements twice as fine (a second solution).
  double error(const PathLoad& load) const;

 private:
  struct Piece {
    CrackElement element;  // in the interface's frame; a tip element runs backwards at the path's end
    CrackElement image;    // its mirror image in y = 0
    double s = 0.0;        // of the element's lower end along the path, m
    double along = 0.0;    // direction of the path, rad
    bool reversed = false;
  };

  void cut();
  void add_piece(std::size_t segment, double from, double to);
  double largest_size(std::size_t segment, double from, double to) const;
  void assemble();
  ElementTraction influence(const Piece& piece, Point z, double across, bool on_element) const;
  CrackElement element_at(Point start, double direction, double length, bool at_tip) const;
  std::size_t piece_at(double s) const;
  Point to_frame(Point z) const { return plane_.beyond ? turn_ * (z - plane_.interface_x) : z; }

  std::vector<Point> path_;
  std::vector<double> s_;  // of the path's points
  CrackPlane plane_;
  BondedMirror mirror_;
  Point turn_{1.0, 0.0};  // the interface to y = 0, the crack above it
  bool first_is_tip_ = true;
  int refine_ = 1;
  double length_ = 0.0;
  std::vector<Piece> elements_;
  Eigen::PartialPivLU<Eigen::MatrixXd> system_;
};

}  // namespace strata::reference
