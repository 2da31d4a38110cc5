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
// particles are stored in single precision, all else in double; id, rock, volume and, without inertia, velocity
// that have not changed since the output time before are the same data sets under further names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "output/history.hpp"
#include "output/packing.hpp"
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

// The bytes of fields of particles that seldom change, by their names.
using ParticleFields = std::map<std::string, std::vector<std::byte>>;

// The file is open only while something is written, so that others may read it during the run; each writing changes it
// as a whole or not at all, also where the process is killed meanwhile (file_change.hpp).
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

  /// Puts the rows (all of them, from the start) under /history. Throws OutputFailure where it cannot be written.
  void write_history(const std::vector<HistoryRow>& rows);

  /// Number of output times in the file.
  std::size_t outputs() const { return outputs_.size(); }
  double last_time_s() const { return outputs_.empty() ? -1.0 : outputs_.back().time_s; }  // -1: none yet

 private:
  // What the .xdmf needs to know about an output time.
  struct OutputSize {
    double time_s = 0.0;
    std::size_t particles = 0;
    std::size_t vertices = 0;  // of the fracture; 0 without one
  };
  void write_xdmf() const;
  std::filesystem::path file_;
  std::vector<OutputSize> outputs_;
  ParticleFields last_;  // of the last output time, where it was written here
  Packer packer_;
};

}  // namespace strata
