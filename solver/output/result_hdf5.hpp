// result.h5: the fields of a run at its output times, and result.xdmf, through which ParaView reads them.
//
//   attributes scene, version    what the run was made with: the resolved scene, the version of strata that began it
//   /times                       time of each output (s)
//   /history/<column>            the columns of history.csv
//   /fracture/00000/...          at the fracture's vertices: x_m, y_m, arc_m, opening_m, slip_m, pressure_Pa,
//                                permeability_m2; attributes time_s, inlet_Pa
//   /interfaces/00000/<k>/...    at the points of the scene's interface k, from 0: x_m, y_m, opening_m, slip_m,
//                                reaction_n_Pa, reaction_t_Pa, split (0 or 1); attributes law, at_m
//   /particles/00000/...         in the order of their id: id, rock, x_m, y_m, u_x_m, u_y_m, v_x_m_s, v_y_m_s, s_xx_Pa,
//                                s_yy_Pa, s_xy_Pa (total stress, tension positive), volume_m2; attribute time_s
//
// Every data set has an attribute `unit`. The number of particles may differ from one output time to the next. The
// normal points from the - to the + side, which is on the left of the path; the tangent runs along the path. Fields of
// particles are stored in single precision, all else in double.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "output/hdf5_io.hpp"
#include "output/history.hpp"
#include "scene/scene.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Total stress of particle p (Pa, tension positive): in-situ stress and, in plane strain, that of the displacement
/// gradient; rocks: in the order of the scene. Throws nothing.
Stress total_stress(const std::vector<Elasticity>& rocks, const Particles& particles, std::size_t p);

// What a run was made with and by; empty texts where it has no output yet.
struct MadeWith {
  std::string scene;    // resolved
  std::string version;  // of strata
};

/// What result.h5 says of the run that it is of; throws nothing but std::bad_alloc.
MadeWith made_with(const std::filesystem::path& file);

// While a run goes on the fields of each output time are a file of their own, result.h5.fields/00000.h5, that is
// written once, and result.h5 refers to them by external links, which readers follow unasked: it is small and replaced
// in one piece. So an output costs the same whatever was written before, and whenever the process is killed all can be
// read. In the end all is copied into result.h5, the place of the one that referred to it.
class ResultFile {
 public:
  /// Starts `file` in place of what was there. Throws OutputFailure if it cannot be written.
  explicit ResultFile(const std::filesystem::path& file);

  /// Goes on behind the first `outputs` output times: later ones are dropped. Throws std::runtime_error where the file
  /// is missing, is none or holds fewer, OutputFailure where it cannot be written.
  ResultFile(const std::filesystem::path& file, std::size_t outputs);

  /// Adds an output time: the fields of `state`, and the .xdmf beside the file. Throws OutputFailure where it
  /// cannot be written.
  void write_output(const Scene& scene, const State& state);

  /// Waits until what was written is on the disc; throws OutputFailure where it cannot be.
  void sync();

  /// Gathers all fields in the file, with the rows (all of them, from the start) under /history: the last that is done
  /// to it. Throws OutputFailure, with all as it was, where the disc has no room.
  void finish(const std::vector<HistoryRow>& rows);

  /// Number of output times in the file.
  std::size_t outputs() const { return outputs_.size(); }
  double last_time_s() const { return outputs_.empty() ? -1.0 : outputs_.back().time_s; }  // -1: none yet

 private:
  // What the file and the .xdmf say of an output time.
  struct Output {
    double time_s = 0.0;
    std::size_t particles = 0;
    std::size_t vertices = 0;  // of the fracture; 0 without one
    bool interfaces = false;
  };
  std::filesystem::path fields_at(std::size_t output) const;
  void write_index() const;
  void write_xdmf() const;
  std::filesystem::path file_;
  MadeWith made_;
  std::vector<Output> outputs_;
  std::size_t synced_ = 0;  // output times that are on the disc for certain
};

}  // namespace strata
