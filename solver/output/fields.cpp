#include "output/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <string_view>
#include <system_error>

#include "output/hdf5_io.hpp"
#include "output/summary.hpp"

namespace strata {

namespace {

// Where a kind of fields is: "/particles/00000".
std::string group_of(const char* kind, std::size_t k) {
  return fmt::format("/{}/{:05}", kind, k);
}

// Unit vector along the path: the normal is on its left.
Vec2 tangent(const SurfacePoint& s) {
  return {s.n.y(), -s.n.x()};
}

// Writes a field of a surface's points: value(point).
void put(hdf5::Id file, const std::string& path, const hdf5::Meaning& meaning, const std::vector<SurfacePoint>& points,
         const auto& value) {
  std::vector<double> field(points.size());
  std::ranges::transform(points, field.begin(), value);
  hdf5::write(file, path, field, meaning);
}

// What ParaView takes of n points: vectors, and which points its cells are made of.
void put_positions(hdf5::Id file, const std::string& group, std::size_t n) {
  hdf5::write_vectors(file, group + "/paraview/position_m", {group + "/x_m", group + "/y_m"}, {"m", "place: x, y, 0"});
  std::vector<std::int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  hdf5::write(file, group + "/paraview/order", order, {"1", "the points, from 0, in their order"}, true);
}

void write_places(hdf5::Id file, const std::string& group, const std::vector<SurfacePoint>& points) {
  put(file, group + "/x_m", {"m", "place, moved with the rock: x"}, points,
      [](const SurfacePoint& s) { return s.x.x() + s.u.x(); });
  put(file, group + "/y_m", {"m", "place, moved with the rock: y"}, points,
      [](const SurfacePoint& s) { return s.x.y() + s.u.y(); });
  put(file, group + "/opening_m", {"m", "opening face to face, negative where faces overlap"}, points,
      [](const SurfacePoint& s) { return s.opening(); });
  put(file, group + "/slip_m", {"m", "slip: motion of the + side (on the left of the path) along the path"}, points,
      [](const SurfacePoint& s) { return s.w.dot(tangent(s)); });
  put_positions(file, group, points.size());
}

void write_fracture(hdf5::Id file, const std::string& group, const Scene& scene, const State& state) {
  const std::vector<SurfacePoint>& vertices = state.fracture().vertices;
  write_places(file, group, vertices);
  put(file, group + "/arc_m", {"m", "length along the path"}, vertices, [](const SurfacePoint& s) { return s.arc; });
  put(file, group + "/permeability_m2", {"m^2", "w^2/12, of the opening w or its floor"}, vertices,
      [&](const SurfacePoint& s) {
        const double w = std::max(s.opening(), scene.fluid.minimum_opening_m);
        return w * w / 12.0;  // between parallel plates
      });
  hdf5::write(file, group + "/pressure_Pa", state.fluid.P, {"Pa", "fluid pressure, positive in compression"});
  hdf5::set_attribute(file, group, "time_s", state.time);
  hdf5::set_attribute(file, group, "inlet_Pa", state.fluid.inlet_Pa);
}

void write_interface(hdf5::Id file, const std::string& interfaces, const Scene& scene, const Surface& surface) {
  // The nearest of the scene: those that never act may have no surface.
  const Vec2& x = surface.vertices.front().x;
  const double at = scene.strata.along == Strata::Along::y ? x.y() : x.x();
  const auto& places = scene.strata.interfaces;
  const auto nearest = std::ranges::min_element(places, {}, [&](const auto& p) { return std::abs(p.at_m - at); });
  const std::string group = fmt::format("{}/{}", interfaces, nearest - places.begin());
  const std::vector<SurfacePoint>& points = surface.points;
  write_places(file, group, points);
  put(file, group + "/reaction_n_Pa", {"Pa", "traction on the + face normal to the interface, positive in compression"},
      points, [](const SurfacePoint& s) { return s.reaction.dot(s.n); });
  put(file, group + "/reaction_t_Pa", {"Pa", "traction on the + face along the interface"}, points,
      [](const SurfacePoint& s) { return s.reaction.dot(tangent(s)); });
  put(file, group + "/failed_s", {"s", "time at which the place let go, -1 where it has not"}, points,
      [](const SurfacePoint& s) { return s.failed_s; });
  std::vector<std::int32_t> split;
  for (const SurfacePoint& s : points) split.push_back(s.split ? 1 : 0);
  hdf5::write(file, group + "/split", split,
              {"1", "1 where the law acts between two sides, 0 where the rock is whole"});
  hdf5::set_attribute(file, group, "law", scene.laws.at(surface.law).name);
  hdf5::set_attribute(file, group, "at_m", nearest->at_m);
}

// Particles in the order of their ids, of which there is one each below next_id and some may be gone.
std::vector<std::size_t> by_id(const Particles& particles) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> order(static_cast<std::size_t>(particles.next_id), none);
  for (std::size_t p = 0; p < particles.size(); ++p) order.at(static_cast<std::size_t>(particles.id[p])) = p;
  std::erase(order, none);
  return order;
}

// Writes a field of particles: value_of(particle). Deflate shortens places, areas, labels and fields of one value much.
// The low bytes of others are noise, over which its search takes as long as small runs do and of which it leaves three
// quarters.
template <class Number>
void put(hdf5::Id file, const std::string& path, const hdf5::Meaning& meaning, const std::vector<std::size_t>& order,
         bool packed, const auto& value_of) {
  std::vector<Number> field;
  field.reserve(order.size());
  for (const std::size_t p : order) field.push_back(static_cast<Number>(value_of(p)));
  const bool one_value = std::ranges::adjacent_find(field, std::not_equal_to{}) == field.end();
  hdf5::write(file, path, field, meaning, packed || one_value);
}

void write_particles(hdf5::Id file, const std::string& group, const Scene& scene, const State& state) {
  const Particles& of = state.particles;
  const Rocks rocks = make_elasticities(scene);
  const std::vector<std::size_t> order = by_id(of);
  const auto field = [&](const char* name, const hdf5::Meaning& meaning, bool packed, const auto& value_of) {
    put<float>(file, group + name, meaning, order, packed, value_of);
  };
  const double moved = scene.numerics.keeps_places() ? 1.0 : 0.0;  // positions are where the rock now is
  field("/x_m", {"m", "place, moved with the rock: x"}, true,
        [&](std::size_t p) { return of.x[p] + moved * of.u_x[p]; });
  field("/y_m", {"m", "place, moved with the rock: y"}, true,
        [&](std::size_t p) { return of.y[p] + moved * of.u_y[p]; });
  field("/volume_m2", {"m^2", "area"}, true, [&](std::size_t p) { return of.V[p]; });
  field("/u_x_m", {"m", "displacement: x"}, false, [&](std::size_t p) { return of.u_x[p]; });
  field("/u_y_m", {"m", "displacement: y"}, false, [&](std::size_t p) { return of.u_y[p]; });
  field("/v_x_m_s", {"m/s", "velocity: x"}, false, [&](std::size_t p) { return of.v_x[p]; });
  field("/v_y_m_s", {"m/s", "velocity: y"}, false, [&](std::size_t p) { return of.v_y[p]; });
  const auto stress = [&](const char* name, const char* component, double Stress::*value) {
    const std::string what = "total stress (in-situ and its change), tension positive: ";
    field(name, {"Pa", what + component}, false, [&](std::size_t p) { return total_stress(rocks, of, p).*value; });
  };
  stress("/s_xx_Pa", "xx", &Stress::xx);
  stress("/s_yy_Pa", "yy", &Stress::yy);
  stress("/s_xy_Pa", "xy", &Stress::xy);
  put<std::int32_t>(file, group + "/id", {"1", "number of the particle"}, order, true,
                    [&](std::size_t p) { return of.id[p]; });
  put<std::int32_t>(file, group + "/rock", {"1", "number of its rock in the scene, from 0"}, order, true,
                    [&](std::size_t p) { return of.rock[p]; });
  put_positions(file, group, order.size());
  hdf5::write_vectors(file, group + "/paraview/displacement_m", {group + "/u_x_m", group + "/u_y_m"},
                      {"m", "displacement: x, y, 0"});
  hdf5::write_vectors(file, group + "/paraview/velocity_m_s", {group + "/v_x_m_s", group + "/v_y_m_s"},
                      {"m/s", "velocity: x, y, 0"});
  hdf5::set_attribute(file, group, "time_s", state.time);
}

void set_made_with(hdf5::Id file, const MadeWith& made) {
  hdf5::set_attribute(file, ".", "scene", made.scene);
  hdf5::set_attribute(file, ".", "version", made.version);
}

// The points of a group with all their fields; topology: how they hang together.
std::string xdmf_grid(hdf5::Id result, const std::string& group, const std::string& name, const char* topology) {
  const auto layout = [&](const std::string& field) { return hdf5::layout(result, group + "/" + field); };
  const auto item = [&](const std::string& field) {
    const hdf5::Layout as = layout(field);
    return fmt::format(
        "<DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" Dimensions=\"{}\">result.h5:{}/{}</DataItem>",
        as.integer ? "Int" : "Float", as.bytes, fmt::join(as.shape, " "), group, field);
  };
  const std::uint64_t n = layout("paraview/order").shape.front();
  const bool line = std::string_view(topology) == "Polyline";
  std::string text = fmt::format(
      "        <Grid Name=\"{}\" GridType=\"Uniform\">\n          <Topology TopologyType=\"{}\" "
      "NumberOfElements=\"{}\" "
      "NodesPerElement=\"{}\">{}</Topology>\n          <Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
      name, topology, line ? 1 : n, line ? n : 1, item("paraview/order"), item("paraview/position_m"));
  const auto add = [&](const std::string& field, const char* type) {
    text += fmt::format("          <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n",
                        field.substr(field.rfind('/') + 1), type, item(field));
  };
  for (const std::string& field : hdf5::names(result, group)) {
    if (field != "paraview" && field != "x_m" && field != "y_m") add(field, "Scalar");
  }
  for (const std::string& field : hdf5::names(result, group + "/paraview")) {
    if (field != "order" && field != "position_m") add("paraview/" + field, "Vector");
  }
  return text + "        </Grid>\n";
}

// In a form that all of ParaView's readers of .xdmf take: places of three components in one data set, and cells named.
std::string xdmf_text(hdf5::Id result, const std::vector<double>& times) {
  std::string text =
      "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times.size(); ++k) {
    text += fmt::format(
        "      <Grid Name=\"{:05}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n        <Time "
        "Value=\"{}\"/>\n",
        k, times[k]);
    text += xdmf_grid(result, group_of("particles", k), "particles", "Polyvertex");
    const std::string fracture = group_of("fracture", k), interfaces = group_of("interfaces", k);
    if (hdf5::exists(result, fracture)) text += xdmf_grid(result, fracture, "fracture", "Polyline");
    if (hdf5::exists(result, interfaces)) {
      for (const std::string& number : hdf5::names(result, interfaces))
        text += xdmf_grid(result, interfaces + "/" + number, "interface " + number, "Polyline");
    }
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace

Stress total_stress(const Rocks& rocks, const Particles& particles, std::size_t p) {
  const Elasticity& rock = rocks[particles.rock[p]];
  return particles.in_situ[p] +
         stress_of(rock, particles.g_xx[p], particles.g_xy[p], particles.g_yx[p], particles.g_yy[p]);
}

void write_fields(const RunFolder& folder, std::size_t k, const Scene& scene, const State& state) {
  hdf5::write_file(folder.fields(k), [&](hdf5::Id file) {
    set_made_with(file, {scene.resolved_toml, version()});
    write_particles(file, group_of("particles", k), scene, state);
    if (state.has_fracture) write_fracture(file, group_of("fracture", k), scene, state);
    for (const Surface& surface : state.surfaces) {
      if (surface.kind == Surface::Kind::interface) write_interface(file, group_of("interfaces", k), scene, surface);
    }
  });
}

void gather_fields(const RunFolder& folder, const std::vector<HistoryColumn>& columns, const std::vector<double>& times,
                   const std::vector<HistoryRow>& rows) {
  const auto write_head = [&](hdf5::Id file) {
    if (!times.empty()) set_made_with(file, made_with(folder));
    for (const char* kind : {"particles", "fracture", "interfaces"}) hdf5::make_group(file, kind);
    hdf5::write(file, "times", times, {"s", "output times"});
    std::vector<double> values(rows.size());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::ranges::transform(rows, values.begin(), [&](const HistoryRow& row) { return row[c]; });
      hdf5::write(file, "history/" + columns[c].name, values, {columns[c].unit, columns[c].description});
    }
  };
  const auto copy_fields = [&](hdf5::Id file) {
    for (std::size_t k = 0; k < times.size(); ++k) {
      const hdf5::Handle fields = hdf5::open_file(folder.fields(k));
      for (const std::string& kind : hdf5::names(fields)) hdf5::copy(fields, group_of(kind.c_str(), k), file);
    }
  };
  write_beside(folder.result(), Sync::yes, [&](const std::filesystem::path& beside) {
    hdf5::write_file(beside, write_head);
    std::uintmax_t room = std::filesystem::file_size(beside);
    for (std::size_t k = 0; k < times.size(); ++k) {
      std::error_code gone;  // as is said where it is copied
      const std::uintmax_t size = std::filesystem::file_size(folder.fields(k), gone);
      if (!gone) room += size;
    }
    take_room(beside, room);
    hdf5::change_in_place(beside, copy_fields);
  });
  atomic_write(folder.xdmf(), xdmf_text(hdf5::open_file(folder.result()), times), Sync::no);
}

MadeWith made_with(const RunFolder& folder) {
  for (const std::filesystem::path& path : {folder.fields(0), folder.result()}) {
    try {
      const hdf5::Handle file = hdf5::open_file(path);
      return {hdf5::text_attribute(file, ".", "scene"), hdf5::text_attribute(file, ".", "version")};
    } catch (const OutputFailure&) {  // is not there, or says nothing
    }
  }
  return {};
}

}  // namespace strata
