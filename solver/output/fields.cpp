#include "output/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <system_error>

#include "output/hdf5_io.hpp"
#include "output/summary.hpp"

namespace strata {
namespace {

// Where a kind of fields is: "/particles/00000".
std::string group_of(const char* kind, std::size_t k) {
  return fmt::format("/{}/{:05}", kind, k);
}

enum class Pack { no, one_value, yes };  // one_value: where all values are equal

// Writes a field of points or particles: value_of(each). Deflate shortens places, areas, labels and fields of one value
// much. The low bytes of others are noise, over which its search takes as long as small runs do and of which it leaves
// three quarters.
template <class Number = double>
void put(const H5::Group& group, const char* name, const std::string& unit, const std::string& what, const auto& all,
         const auto& value_of, Pack pack = Pack::no) {
  std::vector<Number> field;
  field.reserve(all.size());
  for (const auto& each : all) field.push_back(static_cast<Number>(value_of(each)));
  const bool one_value = std::ranges::adjacent_find(field, std::not_equal_to{}) == field.end();
  hdf5::write(group, name, field, unit, what, pack == Pack::yes || (pack == Pack::one_value && one_value));
}

// What ParaView takes of n points: vectors, and which points its cells are made of.
void put_positions(const H5::Group& group, std::size_t n) {
  hdf5::write_vectors(group, "paraview/position_m", "x_m", "y_m", "m", "place: x, y, 0");
  std::vector<std::int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  hdf5::write(group, "paraview/order", order, "1", "the points, from 0, in their order", true);
}

void write_places(const H5::Group& group, const std::vector<SurfacePoint>& points) {
  put(group, "x_m", "m", "place, moved with the rock: x", points, [](auto& s) { return s.x.x() + s.u.x(); });
  put(group, "y_m", "m", "place, moved with the rock: y", points, [](auto& s) { return s.x.y() + s.u.y(); });
  put(group, "opening_m", "m", "opening face to face, negative where faces overlap", points,
      [](auto& s) { return s.opening(); });
  put(group, "slip_m", "m", "slip: motion of the + side (on the left of the path) along the path", points,
      [](auto& s) { return s.w.dot(tangent_of(s.n)); });
  put_positions(group, points.size());
}

void write_fracture(const H5::Group& group, const Scene& scene, const State& state) {
  const std::vector<SurfacePoint>& vertices = state.fracture().vertices;
  const double floor = scene.fluid.minimum_opening_m;
  write_places(group, vertices);
  put(group, "arc_m", "m", "length along the path", vertices, [](auto& s) { return s.arc; });
  put(group, "permeability_m2", "m^2", "w^2/12, of the opening w or its floor", vertices,  // between parallel plates
      [&](auto& s) { return std::pow(std::max(s.opening(), floor), 2) / 12.0; });
  hdf5::write(group, "pressure_Pa", state.fluid.P, "Pa", "fluid pressure, positive in compression");
  hdf5::set_attribute(group, "time_s", state.time);
  hdf5::set_attribute(group, "inlet_Pa", state.fluid.inlet_Pa);
}

void write_interface(const H5::Group& file, const std::string& interfaces, const Scene& scene, const Surface& surface) {
  // The nearest of the scene: those that never act may have no surface.
  const double at = scene.stacking(surface.vertices.front().x);
  const auto& places = scene.strata.interfaces;
  const auto nearest = std::ranges::min_element(places, {}, [&](const auto& p) { return std::abs(p.at_m - at); });
  const H5::Group group = hdf5::make_group(file, fmt::format("{}/{}", interfaces, nearest - places.begin()));
  const std::vector<SurfacePoint>& points = surface.points;
  write_places(group, points);
  put(group, "reaction_n_Pa", "Pa", "traction on the + face normal to the interface, positive in compression", points,
      [](auto& s) { return s.reaction.dot(s.n); });
  put(group, "reaction_t_Pa", "Pa", "traction on the + face along the interface", points,
      [](auto& s) { return s.reaction.dot(tangent_of(s.n)); });
  put(group, "failed_s", "s", "time at which the place let go, -1 where it holds or nothing ever bonded it", points,
      [](auto& s) { return s.failed_s; });
  put<std::int32_t>(group, "split", "1", "1 where the law acts between two sides, 0 where the rock is whole", points,
                    [](auto& s) { return s.split ? 1 : 0; });
  hdf5::set_attribute(group, "law", scene.laws.at(surface.law).name);
  hdf5::set_attribute(group, "at_m", nearest->at_m);
}

// Particles in the order of their ids, of which there is one each below next_id and some may be gone (to sort them
// would take a twentieth of a run without inertia).
std::vector<std::size_t> by_id(const Particles& particles) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> order(static_cast<std::size_t>(particles.next_id), none);
  for (std::size_t p = 0; p < particles.size(); ++p) order.at(static_cast<std::size_t>(particles.id[p])) = p;
  std::erase(order, none);
  return order;
}

void write_particles(const H5::Group& group, const Scene& scene, const State& state) {
  const Particles& of = state.particles;
  const Rocks rocks = make_elasticities(scene);
  const std::vector<std::size_t> order = by_id(of);
  const double moved = scene.numerics.keeps_places() ? 1.0 : 0.0;  // positions are where the rock now is
  const auto field = [&](const char* name, const char* unit, const std::string& what, Pack pack, const auto& value_of) {
    put<float>(group, name, unit, what, order, value_of, pack);
  };
  const auto place = [&](const char* name, const char* what, const SpreadArray& x, const SpreadArray& u) {
    field(name, "m", what, Pack::yes, [&](std::size_t p) { return x[p] + moved * u[p]; });
  };
  place("x_m", "place, moved with the rock: x", of.x, of.u_x);
  place("y_m", "place, moved with the rock: y", of.y, of.u_y);
  field("volume_m2", "m^2", "area", Pack::yes, [&](std::size_t p) { return of.V[p]; });
  const auto plain = [&](const char* name, const char* unit, const char* what, const SpreadArray& values) {
    field(name, unit, what, Pack::one_value, [&](std::size_t p) { return values[p]; });
  };
  plain("u_x_m", "m", "displacement: x", of.u_x);
  plain("u_y_m", "m", "displacement: y", of.u_y);
  plain("v_x_m_s", "m/s", "velocity: x", of.v_x);
  plain("v_y_m_s", "m/s", "velocity: y", of.v_y);
  const auto stress = [&](const char* name, const std::string& component, double Stress::*value) {
    field(name, "Pa", "total stress (in-situ and its change), tension positive: " + component, Pack::one_value,
          [&](std::size_t p) { return total_stress(rocks, of, p).*value; });
  };
  stress("s_xx_Pa", "xx", &Stress::xx);
  stress("s_yy_Pa", "yy", &Stress::yy);
  stress("s_xy_Pa", "xy", &Stress::xy);
  const auto label = [&](const char* name, const char* what, const auto& values) {
    const auto value_of = [&](std::size_t p) { return values[p]; };
    put<std::int32_t>(group, name, "1", what, order, value_of, Pack::yes);
  };
  label("id", "number of the particle", of.id);
  label("rock", "number of its rock in the scene, from 0", of.rock);
  put_positions(group, order.size());
  hdf5::write_vectors(group, "paraview/displacement_m", "u_x_m", "u_y_m", "m", "displacement: x, y, 0");
  hdf5::write_vectors(group, "paraview/velocity_m_s", "v_x_m_s", "v_y_m_s", "m/s", "velocity: x, y, 0");
  hdf5::set_attribute(group, "time_s", state.time);
}

void set_made_with(const H5::Group& file, const MadeWith& made) {
  hdf5::set_attribute(file, "scene", made.scene);
  hdf5::set_attribute(file, "version", made.version);
}

// The points of a group with all their fields; topology: how they hang together.
std::string xdmf_grid(const H5::Group& group, const std::string& name, const char* topology) {
  const auto item = [&](const std::string& field) {
    const H5::DataSet set = group.openDataSet(field);
    hsize_t shape[2];
    const int rank = set.getSpace().getSimpleExtentDims(shape);
    return fmt::format(
        "<DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" Dimensions=\"{}\">result.h5:{}/{}</DataItem>",
        set.getTypeClass() == H5T_INTEGER ? "Int" : "Float", set.getDataType().getSize(),
        fmt::join(shape, shape + rank, " "), group.getObjName(), field);
  };
  const auto n = group.openDataSet("paraview/order").getSpace().getSimpleExtentNpoints();
  const bool line = std::string(topology) == "Polyline";
  std::string text = fmt::format(
      "        <Grid Name=\"{}\" GridType=\"Uniform\">\n          <Topology TopologyType=\"{}\" "
      "NumberOfElements=\"{}\" NodesPerElement=\"{}\">{}</Topology>\n          <Geometry GeometryType=\"XYZ\">{}"
      "</Geometry>\n",
      name, topology, line ? 1 : n, line ? n : 1, item("paraview/order"), item("paraview/position_m"));
  const auto add = [&](const std::string& below, const char* type) {
    for (const std::string& field : hdf5::names(group, "./" + below)) {
      if (field == "paraview" || field == "x_m" || field == "y_m" || field == "order" || field == "position_m")
        continue;
      text += fmt::format("          <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n",
                          field, type, item(below + field));
    }
  };
  add("", "Scalar");
  add("paraview/", "Vector");
  return text + "        </Grid>\n";
}

// In a form that all of ParaView's readers of .xdmf take: places of three components in one data set, and cells named.
std::string xdmf_text(const H5::Group& result, const std::vector<double>& times) {
  std::string text =
      "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t k = 0; k < times.size(); ++k) {
    text += fmt::format(
        "      <Grid Name=\"{:05}\" GridType=\"Collection\" CollectionType=\"Spatial\">\n        <Time "
        "Value=\"{}\"/>\n",
        k, times[k]);
    const auto add = [&](const std::string& path, const std::string& name, const char* topology) {
      if (result.nameExists(path)) text += xdmf_grid(result.openGroup(path), name, topology);
    };
    add(group_of("particles", k), "particles", "Polyvertex");
    add(group_of("fracture", k), "fracture", "Polyline");
    const std::string interfaces = group_of("interfaces", k);
    if (result.nameExists(interfaces)) {
      for (const std::string& number : hdf5::names(result, interfaces))
        add(interfaces + "/" + number, "interface " + number, "Polyline");
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
  hdf5::write_file(folder.fields(k), [&](const H5::Group& file) {
    set_made_with(file, {scene.resolved_toml, version()});
    write_particles(hdf5::make_group(file, group_of("particles", k)), scene, state);
    if (state.has_fracture) write_fracture(hdf5::make_group(file, group_of("fracture", k)), scene, state);
    for (const Surface& surface : state.surfaces) {
      if (surface.kind == Surface::Kind::interface) write_interface(file, group_of("interfaces", k), scene, surface);
    }
  });
}

void gather_fields(const RunFolder& folder, const std::vector<HistoryColumn>& columns, const std::vector<double>& times,
                   const std::vector<HistoryRow>& rows) {
  const auto write_head = [&](const H5::Group& file) {
    if (!times.empty()) set_made_with(file, made_with(folder));
    for (const char* kind : {"particles", "fracture", "interfaces"}) file.createGroup(kind);
    hdf5::write(file, "times", times, "s", "output times");
    std::vector<double> values(rows.size());
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::ranges::transform(rows, values.begin(), [&](const HistoryRow& row) { return row[c]; });
      hdf5::write(file, "history/" + columns[c].name, values, columns[c].unit, columns[c].description);
    }
  };
  const auto copy_fields = [&](const H5::Group& file) {
    for (std::size_t k = 0; k < times.size(); ++k) {
      hdf5::use_file(folder.fields(k), H5F_ACC_RDONLY, [&](const H5::Group& fields) {
        for (const std::string& kind : hdf5::names(fields)) hdf5::copy(fields, group_of(kind.c_str(), k), file);
      });
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
    hdf5::use_file(beside, H5F_ACC_RDWR, copy_fields);
  });
  hdf5::use_file(folder.result(), H5F_ACC_RDONLY,
                 [&](const H5::Group& file) { atomic_write(folder.xdmf(), xdmf_text(file, times), Sync::no); });
}

MadeWith made_with(const RunFolder& folder) {
  MadeWith made;
  for (const std::filesystem::path& path : {folder.fields(0), folder.result()}) {
    try {
      if (made.version.empty())
        hdf5::use_file(path, H5F_ACC_RDONLY, [&](const H5::H5Object& file) {
          made = {hdf5::text_attribute(file, "scene"), hdf5::text_attribute(file, "version")};
        });
    } catch (const OutputFailure&) {  // is not there, or says nothing
    }
  }
  return made;
}

}  // namespace strata
