#include "output/result_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "output/hdf5_io.hpp"
#include "output/run_folder.hpp"
#include "output/summary.hpp"

namespace strata {

namespace {

constexpr const char* kinds[] = {"particles", "fracture", "interfaces"};
constexpr std::size_t index_room = std::size_t{1} << 16U;  // bytes that are taken at a time

std::string number_of(std::size_t output) {
  return fmt::format("{:05}", output);
}

// Unit vector along the path: the normal is on its left.
Vec2 tangent(const SurfacePoint& s) {
  return {s.n.y(), -s.n.x()};
}

// A number at each point of a surface.
struct PointField {
  const char* name;
  const char* unit;
  double (*value)(const SurfacePoint& s);
};
constexpr PointField places[] = {
    {"x_m", "m", [](const SurfacePoint& s) { return s.x.x() + s.u.x(); }},
    {"y_m", "m", [](const SurfacePoint& s) { return s.x.y() + s.u.y(); }},
    {"opening_m", "m", [](const SurfacePoint& s) { return s.opening(); }},
    {"slip_m", "m", [](const SurfacePoint& s) { return s.w.dot(tangent(s)); }},
};
constexpr PointField arc[] = {{"arc_m", "m", [](const SurfacePoint& s) { return s.arc; }}};
constexpr PointField reactions[] = {
    {"reaction_n_Pa", "Pa", [](const SurfacePoint& s) { return s.reaction.dot(s.n); }},
    {"reaction_t_Pa", "Pa", [](const SurfacePoint& s) { return s.reaction.dot(tangent(s)); }},
    {"failed_s", "s", [](const SurfacePoint& s) { return s.failed_s; }},
};

void write_points(hdf5::Id group, const std::vector<SurfacePoint>& points, std::span<const PointField> fields) {
  std::vector<double> values(points.size());
  for (const auto& [name, unit, value] : fields) {
    std::ranges::transform(points, values.begin(), value);
    hdf5::write(group, name, values, unit);
  }
}

void write_fracture(hdf5::Id group, const Scene& scene, const State& state) {
  const std::vector<SurfacePoint>& vertices = state.fracture().vertices;
  if (state.fluid.P.size() != vertices.size()) {
    throw std::logic_error(
        fmt::format("result.h5: {} fluid pressures at {} vertices", state.fluid.P.size(), vertices.size()));
  }
  hdf5::set_attribute(group, ".", "time_s", state.time);
  hdf5::set_attribute(group, ".", "inlet_Pa", state.fluid.inlet_Pa);
  write_points(group, vertices, places);
  write_points(group, vertices, arc);
  hdf5::write(group, "pressure_Pa", state.fluid.P, "Pa");
  std::vector<double> permeability;
  for (const SurfacePoint& s : vertices) {
    const double w = std::max(s.opening(), scene.fluid.minimum_opening_m);
    permeability.push_back(w * w / 12.0);  // between parallel plates
  }
  hdf5::write(group, "permeability_m2", permeability, "m^2");
}

// Number in the scene of the interface that a surface is: the nearest one, since those that never act may have none.
std::size_t interface_of(const Scene& scene, const Surface& surface) {
  const Vec2& x = surface.vertices.front().x;
  const double at = scene.strata.along == Strata::Along::y ? x.y() : x.x();
  const auto& places = scene.strata.interfaces;
  const auto nearest = std::min_element(places.begin(), places.end(), [&](const auto& a, const auto& b) {
    return std::abs(a.at_m - at) < std::abs(b.at_m - at);
  });
  if (nearest == places.end()) throw std::logic_error("result.h5: a surface is no interface of the scene");
  return static_cast<std::size_t>(nearest - places.begin());
}

void write_interface(hdf5::Id group, const Scene& scene, const Surface& surface) {
  hdf5::set_attribute(group, ".", "law", scene.laws.at(surface.law).name);
  hdf5::set_attribute(group, ".", "at_m", scene.strata.interfaces[interface_of(scene, surface)].at_m);
  write_points(group, surface.points, places);
  write_points(group, surface.points, reactions);
  std::vector<std::int32_t> split;
  for (const SurfacePoint& s : surface.points) split.push_back(s.split ? 1 : 0);
  hdf5::write(group, "split", split, "1");
}

// Particles in the order of their ids, of which there is one each below next_id and some may be gone.
std::vector<std::size_t> by_id(const Particles& particles) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> order(static_cast<std::size_t>(particles.next_id), none);
  for (std::size_t p = 0; p < particles.size(); ++p) order.at(static_cast<std::size_t>(particles.id[p])) = p;
  std::erase(order, none);
  return order;
}

// Deflate shortens places, areas, labels and fields of one value much. The low bytes of others are noise, over which
// its search takes as long as small runs do and of which it leaves three quarters.
template <class Number>
void write_field(hdf5::Id group, const std::vector<std::size_t>& order, const std::string& name, const char* unit,
                 const auto& value_of) {
  std::vector<Number> field;
  field.reserve(order.size());
  for (const std::size_t p : order) field.push_back(static_cast<Number>(value_of(p)));
  const bool packed = name == "id" || name == "rock" || name == "volume_m2" || name == "x_m" || name == "y_m" ||
                      std::ranges::adjacent_find(field, std::not_equal_to{}) == field.end();
  hdf5::write(group, name, field, unit, packed ? hdf5::Storage::packed : hdf5::Storage::plain);
}

void write_particles(hdf5::Id group, const Scene& scene, const State& state) {
  const Particles& of = state.particles;
  const std::vector<Elasticity> rocks = make_elasticities(scene);
  const std::vector<std::size_t> order = by_id(of);
  const auto put = [&](const char* name, const char* unit, const auto& value_of) {
    write_field<float>(group, order, name, unit, value_of);
  };
  const double moved = scene.numerics.keeps_places() ? 1.0 : 0.0;  // positions are where the rock now is
  put("x_m", "m", [&](std::size_t p) { return of.x[p] + moved * of.u_x[p]; });
  put("y_m", "m", [&](std::size_t p) { return of.y[p] + moved * of.u_y[p]; });
  put("u_x_m", "m", [&](std::size_t p) { return of.u_x[p]; });
  put("u_y_m", "m", [&](std::size_t p) { return of.u_y[p]; });
  put("v_x_m_s", "m/s", [&](std::size_t p) { return of.v_x[p]; });
  put("v_y_m_s", "m/s", [&](std::size_t p) { return of.v_y[p]; });
  put("volume_m2", "m^2", [&](std::size_t p) { return of.V[p]; });
  put("s_xx_Pa", "Pa", [&](std::size_t p) { return total_stress(rocks, of, p).xx; });
  put("s_yy_Pa", "Pa", [&](std::size_t p) { return total_stress(rocks, of, p).yy; });
  put("s_xy_Pa", "Pa", [&](std::size_t p) { return total_stress(rocks, of, p).xy; });
  write_field<std::int32_t>(group, order, "id", "1", [&](std::size_t p) { return of.id[p]; });
  write_field<std::int32_t>(group, order, "rock", "1", [&](std::size_t p) { return of.rock[p]; });
  hdf5::set_attribute(group, ".", "time_s", state.time);
}

void write_fields(hdf5::Id root, const Scene& scene, const State& state) {
  write_particles(hdf5::group(root, "particles").id(), scene, state);
  if (state.has_fracture) write_fracture(hdf5::group(root, "fracture").id(), scene, state);
  for (const Surface& surface : state.surfaces) {
    if (surface.kind != Surface::Kind::interface) continue;
    const std::string name = fmt::format("interfaces/{}", interface_of(scene, surface));
    write_interface(hdf5::group(root, name).id(), scene, surface);
  }
}

// What the library refuses where a file is written is a failure of the output.
template <class Work>
void require_written(Work work) {
  try {
    work();
  } catch (const OutputFailure&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw OutputFailure(error.what());
  }
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directory(folder, error);
  if (error) throw OutputFailure(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

std::string grid_of(const std::string& name, const std::string& topology, std::size_t n, const std::string& group,
                    int precision, const std::vector<const char*>& fields) {
  const auto item = [&](const char* field) {
    return fmt::format(
        "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"{}\" Dimensions=\"{}\">{}/{}</DataItem>", precision,
        n, group, field);
  };
  std::string text = fmt::format("        <Grid Name=\"{}\" GridType=\"Uniform\">\n          {}\n", name, topology);
  text += fmt::format("          <Geometry GeometryType=\"X_Y\">{}{}</Geometry>\n", item("x_m"), item("y_m"));
  for (const char* field : fields) {
    text += fmt::format("          <Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Node\">{}</Attribute>\n",
                        field, item(field));
  }
  return text + "        </Grid>\n";
}

std::string particle_grid(std::size_t n, const std::string& group) {
  return grid_of("particles", fmt::format("<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\"/>", n), n,
                 group, 4, {"u_x_m", "u_y_m", "v_x_m_s", "v_y_m_s", "s_xx_Pa", "s_yy_Pa", "s_xy_Pa", "volume_m2"});
}

std::string fracture_grid(std::size_t n, const std::string& group) {
  std::string topology = fmt::format(
      "<Topology TopologyType=\"Polyline\" NumberOfElements=\"1\" NodesPerElement=\"{0}\"><DataItem Format=\"XML\" "
      "NumberType=\"Int\" Dimensions=\"1 {0}\">",
      n);
  for (std::size_t k = 0; k < n; ++k) topology += fmt::format("{}{}", k > 0 ? " " : "", k);
  return grid_of("fracture", topology + "</DataItem></Topology>", n, group, 8,
                 {"opening_m", "slip_m", "pressure_Pa", "permeability_m2", "arc_m"});
}

}  // namespace

Stress total_stress(const std::vector<Elasticity>& rocks, const Particles& particles, std::size_t p) {
  const Elasticity& rock = rocks[particles.rock[p]];
  return particles.in_situ[p] +
         stress_of(rock, particles.g_xx[p], particles.g_xy[p], particles.g_yx[p], particles.g_yy[p]);
}

MadeWith made_with(const std::filesystem::path& file) {
  try {
    const hdf5::Handle result = hdf5::open_file(file);
    return {hdf5::text_attribute(result.id(), ".", "scene"), hdf5::text_attribute(result.id(), ".", "version")};
  } catch (const std::runtime_error&) {
    return {};
  }
}

ResultFile::ResultFile(const std::filesystem::path& file) : file_(file) {
  write_index();
  write_xdmf();
  make_folder(fields_of(file));
}

ResultFile::ResultFile(const std::filesystem::path& file, std::size_t outputs) : file_(file), synced_(outputs) {
  if (outputs > 0) made_ = made_with(file);
  {
    const hdf5::Handle result = hdf5::open_file(file);
    const std::vector<double> times = hdf5::read(result.id(), "times");
    if (times.size() < outputs) {
      throw std::runtime_error(
          fmt::format("{}: holds {} output times where {} were expected", file.string(), times.size(), outputs));
    }
    make_folder(fields_of(file));
    for (std::size_t k = 0; k < outputs; ++k) {
      const auto path = [&](std::size_t kind) { return std::string(kinds[kind]) + '/' + number_of(k); };
      const auto there = [&](std::size_t kind) { return hdf5::exists(result.id(), path(kind)); };
      const auto count = [&](std::size_t kind) { return hdf5::read(result.id(), path(kind) + "/x_m").size(); };
      if (!std::filesystem::exists(fields_at(k))) {  // they were gathered already
        hdf5::write_file(fields_at(k), index_room, [&](hdf5::Id root) {
          for (std::size_t kind = 0; kind < std::size(kinds); ++kind) {
            if (there(kind)) hdf5::copy(result.id(), path(kind), root, kinds[kind]);
          }
        });
        synced_ = std::min(synced_, k);
      }
      outputs_.push_back({times[k], count(0), there(1) ? count(1) : 0, there(2)});
    }
  }
  write_index();
  write_xdmf();
}

void ResultFile::write_output(const Scene& scene, const State& state) {
  const std::size_t k = outputs_.size(), particles = state.particles.size();
  constexpr std::size_t of_particle = 12 * sizeof(float);
  const bool interfaces =
      std::ranges::any_of(state.surfaces, [](const Surface& s) { return s.kind == Surface::Kind::interface; });
  if (k == 0) made_ = {scene.resolved_toml, version()};
  outputs_.push_back({state.time, particles, state.has_fracture ? state.fracture().vertices.size() : 0, interfaces});
  try {
    require_written([&] {
      hdf5::open_file(file_);  // throws where it is gone or torn
      hdf5::write_file(fields_at(k), index_room + of_particle * particles,
                       [&](hdf5::Id root) { write_fields(root, scene, state); });
      write_index();
    });
  } catch (...) {
    outputs_.pop_back();
    throw;
  }
  write_xdmf();
}

void ResultFile::sync() {
  for (; synced_ < outputs_.size(); ++synced_) sync_file(fields_at(synced_));
  sync_file(file_);
}

void ResultFile::finish(const std::vector<HistoryRow>& rows) {
  const std::vector<HistoryColumn>& columns = history_columns();
  const auto gather = [&](hdf5::Id root) {
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      const hdf5::Handle fields = hdf5::open_file(fields_at(k));
      for (const std::string& kind : hdf5::names(fields.id()))
        hdf5::copy(fields.id(), kind, hdf5::group(root, kind).id(), number_of(k));
    }
    const hdf5::Handle history = hdf5::group(root, "history");
    std::vector<double> values(rows.size());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::ranges::transform(rows, values.begin(), [&](const HistoryRow& row) { return row[c]; });
      hdf5::write(history.id(), columns[c].name, values, columns[c].unit);
    }
  };
  require_written([&] {
    std::uintmax_t size = std::filesystem::file_size(file_);
    for (std::size_t k = 0; k < outputs_.size(); ++k) size += std::filesystem::file_size(fields_at(k));
    size += columns.size() * sizeof(double) * (rows.size() + 1024);
    write_beside(file_, Sync::yes, [&](const std::filesystem::path& beside) {
      write_with_room(beside, read_whole(file_), size);
      hdf5::change_in_place(beside, gather);
    });
  });
  std::error_code left;  // it harms nobody
  std::filesystem::remove_all(fields_of(file_), left);
}

std::filesystem::path ResultFile::fields_at(std::size_t output) const {
  return fields_of(file_) / (number_of(output) + ".h5");
}

void ResultFile::write_index() const {
  hdf5::write_file(file_, index_room, [&](hdf5::Id root) {
    if (!made_.scene.empty()) {
      hdf5::set_attribute(root, ".", "scene", made_.scene);
      hdf5::set_attribute(root, ".", "version", made_.version);
    }
    std::vector<double> times;
    for (const Output& output : outputs_) times.push_back(output.time_s);
    hdf5::write(root, "times", times, "s");
    hdf5::group(root, "history");
    for (std::size_t kind = 0; kind < std::size(kinds); ++kind) {
      const hdf5::Handle group = hdf5::group(root, kinds[kind]);
      for (std::size_t k = 0; k < outputs_.size(); ++k) {
        const bool there[] = {true, outputs_[k].vertices > 0, outputs_[k].interfaces};
        const std::string file = fields_of(file_.filename()) / (number_of(k) + ".h5");
        if (there[kind]) hdf5::link_to_file(group.id(), number_of(k), file, std::string("/") + kinds[kind]);
      }
    }
  });
}

void ResultFile::write_xdmf() const {
  const std::string name = file_.filename().string();
  std::string text =
      "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"
      "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    const Output& output = outputs_[k];
    text += fmt::format(
        "      <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n        <Time Value=\"{}\"/>\n",
        number_of(k), output.time_s);
    text += particle_grid(output.particles, name + ":/particles/" + number_of(k));
    if (output.vertices > 0) text += fracture_grid(output.vertices, name + ":/fracture/" + number_of(k));
    text += "      </Grid>\n";
  }
  auto file = file_;
  atomic_write(file.replace_extension(".xdmf"), text + "    </Grid>\n  </Domain>\n</Xdmf>\n", Sync::no);
}

}  // namespace strata
