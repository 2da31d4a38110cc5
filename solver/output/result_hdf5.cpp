#include "output/result_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "output/file_change.hpp"
#include "output/hdf5_io.hpp"
#include "output/run_folder.hpp"
#include "output/summary.hpp"

namespace strata {

namespace {

std::string number_of(std::size_t output) {
  return fmt::format("{:05}", output);
}

// Unit vector along the path: the normal is on its left.
Vec2 tangent(const SurfacePoint& s) {
  return {s.n.y(), -s.n.x()};
}

template <class Value>
std::vector<double> collect(const std::vector<SurfacePoint>& points, Value value) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const SurfacePoint& s : points) values.push_back(value(s));
  return values;
}

void write_places(hdf5::Id group, const std::vector<SurfacePoint>& points) {
  hdf5::write(group, "x_m", collect(points, [](const SurfacePoint& s) { return s.x.x() + s.u.x(); }), "m");
  hdf5::write(group, "y_m", collect(points, [](const SurfacePoint& s) { return s.x.y() + s.u.y(); }), "m");
  hdf5::write(group, "opening_m", collect(points, [](const SurfacePoint& s) { return s.opening(); }), "m");
  hdf5::write(group, "slip_m", collect(points, [](const SurfacePoint& s) { return s.w.dot(tangent(s)); }), "m");
}

void write_fracture(hdf5::Id group, const Scene& scene, const State& state) {
  const std::vector<SurfacePoint>& vertices = state.fracture().vertices;
  if (state.fluid.P.size() != vertices.size()) {
    throw std::logic_error(
        fmt::format("result.h5: {} fluid pressures at {} vertices", state.fluid.P.size(), vertices.size()));
  }
  hdf5::set_attribute(group, ".", "time_s", state.time);
  hdf5::set_attribute(group, ".", "inlet_Pa", state.fluid.inlet_Pa);
  write_places(group, vertices);
  const auto permeability = [&](const SurfacePoint& s) {
    const double w = std::max(s.opening(), scene.fluid.minimum_opening_m);
    return w * w / 12.0;  // between parallel plates
  };
  hdf5::write(group, "arc_m", collect(vertices, [](const SurfacePoint& s) { return s.arc; }), "m");
  hdf5::write(group, "pressure_Pa", state.fluid.P, "Pa");
  hdf5::write(group, "permeability_m2", collect(vertices, permeability), "m^2");
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
  const std::vector<SurfacePoint>& points = surface.points;
  write_places(group, points);
  const auto along = [](const SurfacePoint& s) { return s.reaction.dot(tangent(s)); };
  hdf5::write(group, "reaction_n_Pa", collect(points, [](const SurfacePoint& s) { return s.reaction.dot(s.n); }), "Pa");
  hdf5::write(group, "reaction_t_Pa", collect(points, along), "Pa");
  std::vector<std::int32_t> split;
  for (const SurfacePoint& s : points) split.push_back(s.split ? 1 : 0);
  hdf5::write(group, "split", split, "1");
  hdf5::write(group, "failed_s", collect(points, [](const SurfacePoint& s) { return s.failed_s; }), "s");
}

// Particles in the order of their ids, of which there is one each below next_id and some may be gone.
std::vector<std::size_t> by_id(const Particles& particles) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> order(static_cast<std::size_t>(particles.next_id), none);
  for (std::size_t p = 0; p < particles.size(); ++p) order.at(static_cast<std::size_t>(particles.id[p])) = p;
  std::erase(order, none);
  return order;
}

bool same_bytes(std::span<const std::byte> a, std::span<const std::byte> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size()) == 0);
}

// Fields that seldom change, so that it pays to keep them for the next output time.
bool is_steady(const Scene& scene, const std::string& field) {
  const bool at_rest = scene.numerics.mechanics == Numerics::Mechanics::quasistatic;
  return field == "id" || field == "rock" || field == "volume_m2" || (at_rest && field.starts_with("v_"));
}

// Writes the particles' fields into `group` and returns the steady ones; those that are as in `last`, of the group at
// the path `before`, are linked to.
ParticleFields write_particles(hdf5::Id group, const Scene& scene, const State& state, const ParticleFields& last,
                               const std::string& before, Packer& packer) {
  const Particles& particles = state.particles;
  const std::vector<Elasticity> rocks = make_elasticities(scene);
  const std::vector<std::size_t> order = by_id(particles);

  ParticleFields written;
  const auto write = [&](const std::string& name, const char* unit, const auto& values) {
    const auto bytes = std::as_bytes(std::span(values));
    const auto old = last.find(name);
    if (old != last.end() && same_bytes(old->second, bytes)) {
      hdf5::link(group, name, before + "/" + name);
    } else {
      hdf5::write_compressed(group, name, values, unit, packer);
    }
    if (is_steady(scene, name)) written.emplace(name, std::vector<std::byte>(bytes.begin(), bytes.end()));
  };
  std::vector<float> field(order.size());
  const auto put = [&](const char* name, const char* unit, auto value) {
    std::transform(order.begin(), order.end(), field.begin(), [&](auto p) { return static_cast<float>(value(p)); });
    write(name, unit, field);
  };
  const auto put_array = [&](const char* name, const char* unit, const SpreadArray& values) {
    put(name, unit, [&](std::size_t p) { return values[p]; });
  };
  const double moved = scene.numerics.keeps_places() ? 1.0 : 0.0;  // positions are where the rock now is
  put("x_m", "m", [&](std::size_t p) { return particles.x[p] + moved * particles.u_x[p]; });
  put("y_m", "m", [&](std::size_t p) { return particles.y[p] + moved * particles.u_y[p]; });
  put_array("u_x_m", "m", particles.u_x);
  put_array("u_y_m", "m", particles.u_y);
  put_array("v_x_m_s", "m/s", particles.v_x);
  put_array("v_y_m_s", "m/s", particles.v_y);
  put_array("volume_m2", "m^2", particles.V);
  put("s_xx_Pa", "Pa", [&](std::size_t p) { return total_stress(rocks, particles, p).xx; });
  put("s_yy_Pa", "Pa", [&](std::size_t p) { return total_stress(rocks, particles, p).yy; });
  put("s_xy_Pa", "Pa", [&](std::size_t p) { return total_stress(rocks, particles, p).xy; });

  std::vector<std::int32_t> label(order.size());
  std::transform(order.begin(), order.end(), label.begin(), [&](auto p) { return particles.id[p]; });
  write("id", "1", label);
  std::transform(order.begin(), order.end(), label.begin(), [&](auto p) { return particles.rock[p]; });
  write("rock", "1", label);
  hdf5::set_attribute(group, ".", "time_s", state.time);
  return written;
}

template <class Outputs>
std::vector<double> times_of(const Outputs& outputs) {
  std::vector<double> times;
  for (const auto& output : outputs) times.push_back(output.time_s);
  return times;
}

// Opens the file, lets `change` write to it and closes it; it changes as a whole or not at all.
template <class Change>
void change_file(const std::filesystem::path& path, Change change) {
  hdf5::FileChange file(path);
  change(file.id());
  file.commit();
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
    hdf5::finish_change(file);
    const hdf5::Handle result = hdf5::open_file(file, false);
    return {hdf5::text_attribute(result.id(), ".", "scene"), hdf5::text_attribute(result.id(), ".", "version")};
  } catch (const std::runtime_error&) {
    return {};
  }
}

ResultFile::ResultFile(const std::filesystem::path& file) : file_(file) {
  hdf5::make_file(file);
  change_file(file, [&](hdf5::Id root) {
    hdf5::rewrite(root, "times", {}, "s");
    for (const char* name : {"history", "particles", "fracture", "interfaces"}) hdf5::group(root, name);
  });
  write_xdmf();
}

ResultFile::ResultFile(const std::filesystem::path& file, std::size_t outputs) : file_(file) {
  hdf5::finish_change(file);
  {
    const hdf5::Handle result = hdf5::open_file(file, false);
    const std::vector<double> times = hdf5::read(result.id(), "times");
    if (times.size() < outputs) {
      throw std::runtime_error(
          fmt::format("{}: holds {} output times where {} were expected", file.string(), times.size(), outputs));
    }
    for (std::size_t k = 0; k < outputs; ++k) {
      const std::string line = "fracture/" + number_of(k) + "/x_m";
      outputs_.push_back({times[k], hdf5::length(result.id(), "particles/" + number_of(k) + "/x_m"),
                          hdf5::exists(result.id(), line) ? hdf5::length(result.id(), line) : 0});
    }
  }
  change_file(file, [&](hdf5::Id root) {
    for (const char* kind : {"particles", "fracture", "interfaces"}) {
      const hdf5::Handle group = hdf5::group(root, kind);
      for (const std::string& name : hdf5::names(group.id())) {
        if (std::stoul(name) >= outputs) hdf5::remove(group.id(), name);
      }
    }
    hdf5::rewrite(root, "times", times_of(outputs_), "s");
  });
  write_xdmf();
}

void ResultFile::write_output(const Scene& scene, const State& state) {
  const std::string number = number_of(outputs_.size());
  std::vector<OutputSize> outputs = outputs_;
  outputs.push_back(
      {state.time, state.particles.size(), state.has_fracture ? state.fracture().vertices.size() : std::size_t{0}});
  ParticleFields fields;
  change_file(file_, [&](hdf5::Id root) {
    if (outputs_.empty()) {
      hdf5::set_attribute(root, ".", "scene", scene.resolved_toml);
      hdf5::set_attribute(root, ".", "version", version());
    }
    const std::string before = outputs_.empty() ? "" : "/particles/" + number_of(outputs_.size() - 1);
    fields = write_particles(hdf5::group(root, "particles/" + number).id(), scene, state, last_, before, packer_);
    if (state.has_fracture) write_fracture(hdf5::group(root, "fracture/" + number).id(), scene, state);
    for (const Surface& surface : state.surfaces) {
      if (surface.kind != Surface::Kind::interface) continue;
      const std::string name = fmt::format("interfaces/{}/{}", number, interface_of(scene, surface));
      write_interface(hdf5::group(root, name).id(), scene, surface);
    }
    hdf5::rewrite(root, "times", times_of(outputs), "s");
  });
  outputs_ = std::move(outputs);
  last_ = std::move(fields);
  write_xdmf();
}

void ResultFile::write_history(const std::vector<HistoryRow>& rows) {
  change_file(file_, [&](hdf5::Id root) {
    const hdf5::Handle group = hdf5::group(root, "history");
    std::vector<double> values(rows.size());
    for (const HistoryColumn& column : history_columns()) {
      std::transform(rows.begin(), rows.end(), values.begin(), [&](const auto& row) { return row.*column.value; });
      hdf5::rewrite(group.id(), column.name, values, column.unit);
    }
  });
}

void ResultFile::write_xdmf() const {
  const std::string name = file_.filename().string();
  std::string text =
      "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"2.0\">\n  <Domain>\n"
      "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < outputs_.size(); ++k) {
    const OutputSize& output = outputs_[k];
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
