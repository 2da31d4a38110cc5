// result.h5: the fields of a run at its output times, and result.xdmf, through which ParaView reads them.
// Its attributes `scene` and `version` say what the run was made with. /times are the output times, /history has the
// columns of history.csv; /fracture/00000, /particles/00000 (in the order of their id) and /interfaces/00000/<k> (of
// the scene's interface k, from 0) the fields at the first output time, which fields.cpp lists. Every data set has
// attributes `unit` and `description`, and the .xdmf names all that these groups hold. The number of particles may
// change. The normal points from the - to the + side, on the left of the path, along which the tangent runs. Particles
// are stored in single precision, all else in double. While a run goes on each output time is a file of its own,
// RunFolder::fields(k), with the same paths: it costs the same whatever was written before, and whenever the process is
// killed all can be read.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "output/history.hpp"
#include "output/run_folder.hpp"
#include "scene/scene.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Total stress of particle p (Pa, tension positive): in-situ stress and, in plane strain, that of the displacement
/// gradient; rocks: in the order of the scene. Throws nothing.
Stress total_stress(const Rocks& rocks, const Particles& particles, std::size_t p);

/// Writes the file of output time k; throws OutputFailure where it cannot be written.
void write_fields(const RunFolder& folder, std::size_t k, const Scene& scene, const State& state);

/// Gathers the files of the output times (s) in result.h5, with the rows of the history, and writes the .xdmf. Throws
/// OutputFailure, with all as it was, where the disc has no room.
void gather_fields(const RunFolder& folder, const std::vector<HistoryColumn>& columns, const std::vector<double>& times,
                   const std::vector<HistoryRow>& rows);

// What a run was made with and by; empty texts where it has no output yet.
struct MadeWith {
  std::string scene;    // resolved
  std::string version;  // of strata
};

/// What the files of a run say of it; throws nothing but std::bad_alloc.
MadeWith made_with(const RunFolder& folder);

}  // namespace strata
