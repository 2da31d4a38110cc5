#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <thread>

#include "output/fields.hpp"
#include "output/recorder.hpp"
#include "output_state.hpp"
#include "result_file.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// What is stored in single precision.
double stored(double value) {
  return static_cast<double>(static_cast<float>(value));
}

// A later state, with more particles and a longer fracture.
State later_state() {
  State state = made_state();
  Numbers number{3000};
  state.particles = made_particles(25, number);
  extend(state.fracture(), true, Vec2{4.5, 3.0}, 10.0);
  state.fluid.P.push_back(1.5e6 / 0.7);
  state.time += 0.1;
  return state;
}

// The result of a run with these outputs.
std::filesystem::path result_of(const TemporaryFolder& folder, const std::vector<State>& states,
                                const Scene& scene = made_scene()) {
  Recorder recorder(RunFolder{folder.path});
  for (const State& state : states) recorder.output(scene, state);
  recorder.gather();
  return RunFolder{folder.path}.result();
}

// All that the file says, with the paths: equal texts mean equal content.
std::string dump(const H5::Group& parent, const std::string& path) {
  std::string text;
  for (const std::string& name : hdf5::names(parent, path)) {
    const std::string at = path + "/" + name;
    text += at;
    if (hdf5::is_group(parent, at)) {
      text += '\n' + dump(parent, at);
      continue;
    }
    text += fmt::format(" [{}]", hdf5::text_attribute(parent, at, "unit"));
    CHECK(hdf5::text_attribute(parent, at, "description").size() > 3);
    text += fmt::format(" {}\n", fmt::join(hdf5::read(parent, at), " "));
  }
  return text;
}

std::string dump(const std::filesystem::path& file) {
  return dump(hdf5::open_file(file), ".");
}

}  // namespace

TEST_CASE("the fracture's fields are those of its vertices") {
  const TemporaryFolder folder;
  Scene scene = made_scene();
  State state = made_state();
  state.fracture().vertices[0].w = {-3e-3, 5e-4};  // opens by 3 mm, the + side slips 0.5 mm up the path
  state.fracture().vertices[1].w = {-5e-5, 0.0};   // less open than minimum_opening_m
  const auto file = hdf5::open_file(result_of(folder, {state}, scene));
  const std::string at = "fracture/00000/";
  CHECK(hdf5::read(file, at + "x_m") == std::vector<double>{4.0, 4.0, 4.0});
  CHECK(hdf5::read(file, at + "y_m") == std::vector<double>{0.0, 1.0, 2.0});
  CHECK(hdf5::read(file, at + "arc_m") == std::vector<double>{0.0, 1.0, 2.0});
  CHECK(hdf5::read(file, at + "pressure_Pa") == state.fluid.P);
  CHECK(hdf5::read(file, at + "opening_m")[0] == Approx(3e-3));
  CHECK(hdf5::read(file, at + "opening_m")[1] == Approx(5e-5));
  CHECK(hdf5::read(file, at + "slip_m")[0] == Approx(5e-4));
  CHECK(hdf5::read(file, at + "permeability_m2")[0] == Approx(9e-6 / 12.0));
  CHECK(hdf5::read(file, at + "permeability_m2")[1] == Approx(1e-8 / 12.0));
  CHECK(hdf5::number_attribute(file, at, "time_s") == state.time);
  CHECK(hdf5::number_attribute(file, at, "inlet_Pa") == state.fluid.inlet_Pa);
  CHECK(hdf5::text_attribute(file, at + "permeability_m2", "unit") == "m^2");
  CHECK(hdf5::text_attribute(file, at + "pressure_Pa", "unit") == "Pa");
  CHECK(hdf5::names(file, at).size() == 7 + 1);  // and what ParaView takes
  CHECK(hdf5::read(file, at + "paraview/position_m") == std::vector<double>{4, 0, 0, 4, 1, 0, 4, 2, 0});
  CHECK(hdf5::read(file, "times") == std::vector<double>{state.time});
}

// Requires that fields come back bit for bit, of one chunk and more, packed or not; packed ones that repeat take less.
TEST_CASE("large fields are packed without loss") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path / "fields.h5";
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{5000}, std::size_t{600001}}) {
    std::vector<float> smooth(n);
    std::vector<std::int32_t> label(n);
    for (std::size_t k = 0; k < n; ++k) {
      smooth[k] = static_cast<float>(3e5 * std::sin(1e-3 * static_cast<double>(k)));
      label[k] = static_cast<std::int32_t>(k);
    }
    for (const bool packed : {false, true}) {
      hdf5::write_file(path, [&](const H5::Group& root) {
        hdf5::write(root, "smooth", smooth, "Pa", "a wave", packed);
        hdf5::write(root, "label", label, "1", "a number", packed);
      });
      const H5::H5File file = hdf5::open_file(path);
      const std::vector<double> read = hdf5::read(file, "smooth"), labels = hdf5::read(file, "label");
      CHECK(std::equal(read.begin(), read.end(), smooth.begin(), smooth.end(),
                       [](double a, float b) { return a == static_cast<double>(b); }));
      CHECK(std::equal(labels.begin(), labels.end(), label.begin(), label.end()));
      const auto size = static_cast<double>(content_of(path).size()), whole = 8.0 * static_cast<double>(n);
      if (n >= 5000) CHECK(size / whole < (packed ? 0.65 : 1.2));
    }
  }
}

TEST_CASE("an interface's fields are those of its points, under its number in the scene") {
  const TemporaryFolder folder;
  State state = made_state();
  SurfacePoint& first = state.surfaces[1].points[0];
  first.w = {2e-3, 1e-3};  // normal up, tangent to the right
  first.reaction = {3e5, 4e5};
  first.failed_s = 0.25;
  const auto file = hdf5::open_file(result_of(folder, {state}));
  // The surface lies at y = 5, on the second interface of the scene; the first, which never acts, has none.
  CHECK(hdf5::names(file, "interfaces/00000") == std::vector<std::string>{"1"});
  const std::string at = "interfaces/00000/1/";
  CHECK(hdf5::text_attribute(file, at, "law") == "bedding");
  CHECK(hdf5::number_attribute(file, at, "at_m") == 5.0);
  CHECK(hdf5::read(file, at + "x_m") == std::vector<double>{1.0, 3.0, 5.0, 7.0});
  CHECK(hdf5::read(file, at + "y_m") == std::vector<double>(4, 5.0));
  CHECK(hdf5::read(file, at + "opening_m")[0] == Approx(1e-3));
  CHECK(hdf5::read(file, at + "slip_m")[0] == Approx(2e-3));
  CHECK(hdf5::read(file, at + "reaction_n_Pa")[0] == Approx(4e5));
  CHECK(hdf5::read(file, at + "reaction_t_Pa")[0] == Approx(3e5));
  const auto split = hdf5::read(file, at + "split");
  for (std::size_t k = 0; k < 4; ++k) CHECK(split[k] == (state.surfaces[1].points[k].split ? 1.0 : 0.0));
  CHECK(hdf5::text_attribute(file, at + "reaction_n_Pa", "unit") == "Pa");
  CHECK(hdf5::read(file, at + "failed_s")[0] == 0.25);
  CHECK(hdf5::text_attribute(file, at + "failed_s", "unit") == "s");
}

TEST_CASE("total stress is the in-situ stress and plane strain's Hooke's law") {
  const Scene scene = made_scene();
  Numbers number;
  Particles particles = made_particles(1, number);
  particles.rock[0] = 0;  // 40 GPa, 0.25
  particles.in_situ[0] = {-16e6, -20e6, 1e6};
  particles.g_xx[0] = 1e-4, particles.g_yy[0] = -2e-4, particles.g_xy[0] = 3e-4, particles.g_yx[0] = -1e-4;
  // By hand: strain (s - nu (s' + s'')) (1/E), with s'' = nu (s + s'); lambda = mu = 16 GPa at nu = 1/4.
  const Stress s = total_stress(make_elasticities(scene), particles, 0);
  CHECK(s.xx == Approx(-16e6 + 16e9 * (3 * 1e-4 - 2e-4)));
  CHECK(s.yy == Approx(-20e6 + 16e9 * (1e-4 - 3 * 2e-4)));
  CHECK(s.xy == Approx(1e6 + 16e9 * 2e-4));
}

TEST_CASE("particles are written in the order of their id, and their number may change") {
  const TemporaryFolder folder;
  const Scene scene = made_scene();
  const Rocks rocks = make_elasticities(scene);
  const std::vector<State> states{made_state(), later_state()};
  const auto file = hdf5::open_file(result_of(folder, states));
  for (std::size_t k = 0; k < 2; ++k) {
    const Particles& p = states[k].particles;
    const std::string at_k = fmt::format("particles/{:05}/", k);
    CHECK(hdf5::number_attribute(file, at_k, "time_s") == states[k].time);
    const auto field = [&](const char* name, const char* unit) {
      CHECK(hdf5::text_attribute(file, at_k + name, "unit") == unit);
      return hdf5::read(file, at_k + name);
    };
    const auto x = field("x_m", "m"), y = field("y_m", "m"), u_x = field("u_x_m", "m"), u_y = field("u_y_m", "m");
    const auto v_x = field("v_x_m_s", "m/s"), v_y = field("v_y_m_s", "m/s"), V = field("volume_m2", "m^2");
    const auto s_xx = field("s_xx_Pa", "Pa"), s_yy = field("s_yy_Pa", "Pa"), s_xy = field("s_xy_Pa", "Pa");
    const auto rock = field("rock", "1"), ids = field("id", "1");
    CHECK(hdf5::names(file, at_k).size() == 12 + 1);  // and what ParaView takes
    REQUIRE(x.size() == p.size());
    const auto moved = field("paraview/displacement_m", "m"), runs = field("paraview/velocity_m_s", "m/s");
    CHECK(hdf5::shape(file, at_k + "paraview/displacement_m") == std::vector<hsize_t>{p.size(), 3});
    for (std::size_t q = 0; q < p.size(); ++q) {
      const auto at = static_cast<std::size_t>(p.id[q]);  // ids of the made-up particles are 0 to n - 1
      CHECK(ids[at] == static_cast<double>(at));
      CHECK(x[at] == stored(p.x[q]));
      CHECK(y[at] == stored(p.y[q]));
      CHECK(u_x[at] == stored(p.u_x[q]));
      CHECK(u_y[at] == stored(p.u_y[q]));
      CHECK(v_x[at] == stored(p.v_x[q]));
      CHECK(v_y[at] == stored(p.v_y[q]));
      CHECK(V[at] == stored(p.V[q]));
      CHECK(std::vector(&moved[3 * at], &moved[3 * at] + 3) == std::vector{u_x[at], u_y[at], 0.0});
      CHECK(std::vector(&runs[3 * at], &runs[3 * at] + 3) == std::vector{v_x[at], v_y[at], 0.0});
      CHECK(rock[at] == static_cast<double>(p.rock[q]));
      CHECK(s_xx[at] == stored(total_stress(rocks, p, q).xx));
      CHECK(s_yy[at] == stored(total_stress(rocks, p, q).yy));
      CHECK(s_xy[at] == stored(total_stress(rocks, p, q).xy));
    }
  }
}

// Mutation that fails: an output that carries what was written before.
TEST_CASE("an output time costs the same however many there were") {
  const TemporaryFolder folder;
  State state = made_state();
  Numbers number{5};
  state.particles = made_particles(20000, number);
  Recorder recorder(RunFolder{folder.path});
  for (int k = 0; k < 20; ++k) recorder.output(made_scene(), state);
  const auto size = [&](std::size_t k) { return std::filesystem::file_size(RunFolder{folder.path}.fields(k)); };
  CHECK(size(19) == size(0));
  CHECK(size(0) > 7 * 4 * 20000);
}

TEST_CASE("/history holds the columns of history.csv, however often it is gathered") {
  const TemporaryFolder folder;
  Recorder recorder(RunFolder{folder.path});
  State state = made_state();
  std::vector<double> J;
  for (int k = 0; k < 3; ++k) {
    J.push_back(state.tips[0].J = 1.0 / (3.0 + k));
    recorder.row(made_scene(), state);
    recorder.gather();
  }
  const auto file = hdf5::open_file(folder.path / "result.h5");
  CHECK(hdf5::read(file, "history/J_N_m") == J);
  CHECK(hdf5::text_attribute(file, "history/J_N_m", "unit") == "N/m");
  CHECK(hdf5::names(file, "history").size() == history_columns().size());
}

TEST_CASE("the .xdmf names data sets that exist, of the shape they have") {
  const TemporaryFolder folder;
  const auto file = hdf5::open_file(result_of(folder, {made_state(), later_state()}));
  const std::string text = content_of(folder.path / "result.xdmf");
  std::size_t items = 0;
  for (std::size_t at = text.find("result.h5:/"); at != std::string::npos; at = text.find("result.h5:/", at + 1)) {
    const std::string path = text.substr(at + 11, text.find('<', at) - at - 11);
    INFO(path);
    const std::size_t dimensions = text.rfind("Dimensions=\"", at) + 12;
    CHECK(fmt::format("{}\">", fmt::join(hdf5::shape(file, path), " ")) == text.substr(dimensions, at - dimensions));
    ++items;
  }
  CHECK(items == 2 * ((4 + 10) + (2 + 5) + (2 + 6)));  // particles, fracture, one interface
  CHECK(text.find(fmt::format("<Time Value=\"{}\"/>", made_state().time)) != std::string::npos);
  CHECK(text.find("TopologyType=\"Polyvertex\" NumberOfElements=\"25\"") != std::string::npos);
}

TEST_CASE("a scene without fracture and interfaces has particles alone") {
  const TemporaryFolder folder;
  State state = made_state();
  state.has_fracture = false;
  state.surfaces.clear();
  const auto file = hdf5::open_file(result_of(folder, {state}));
  CHECK(file.nameExists("particles/00000/x_m"));
  CHECK_FALSE(file.nameExists("fracture/00000"));
  CHECK_FALSE(file.nameExists("interfaces/00000"));
  CHECK(content_of(folder.path / "result.xdmf").find("fracture") == std::string::npos);
}

TEST_CASE("equal runs write equal bytes, whenever they are run") {
  const TemporaryFolder a, b;
  for (const auto& folder : {&a, &b}) {
    if (folder == &b) std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // dates are in whole seconds
    Recorder recorder(RunFolder{folder->path});
    recorder.output(made_scene(), made_state());
    recorder.row(made_scene(), later_state());
    recorder.checkpoint(made_scene(), {later_state(), recorder.written()});
    recorder.output(made_scene(), later_state());
    recorder.gather();
  }
  for (const char* name : {"history.csv", "result.h5", "result.xdmf", "checkpoint.bin"}) {
    INFO(name);
    CHECK(content_of(a.path / name) == content_of(b.path / name));
  }
}

TEST_CASE("a run that goes on from a checkpoint ends with the content of an uninterrupted one") {
  const Scene scene = made_scene();
  const State first = made_state(), second = later_state();
  State third = later_state();
  third.time += 0.1;
  const TemporaryFolder whole, broken;
  {
    Recorder recorder(RunFolder{whole.path});
    recorder.output(scene, first);
    recorder.row(scene, second);
    recorder.output(scene, second);
    recorder.output(scene, third);
    recorder.gather();
  }
  {
    Recorder recorder(RunFolder{broken.path});
    recorder.output(scene, first);
    recorder.row(scene, second);
    recorder.checkpoint(scene, {second, recorder.written()});
    recorder.output(scene, third);  // cut off again: the run stops here and goes on from the checkpoint
    recorder.row(scene, first);
    recorder.gather();
  }
  const RunFolder folder{broken.path};
  const Checkpoint checkpoint = load_checkpoint(folder.checkpoint(), scene);
  {
    Recorder recorder(folder, checkpoint.written);
    CHECK(recorder.written().rows.size() == 2);
    CHECK(recorder.written().output_times.size() == 1);
    recorder.output(scene, checkpoint.state);
    recorder.output(scene, third);
    recorder.gather();
  }
  CHECK(content_of(folder.history()) == content_of(RunFolder{whole.path}.history()));
  CHECK(content_of(folder.xdmf()) == content_of(RunFolder{whole.path}.xdmf()));
  CHECK(dump(folder.result()) == dump(RunFolder{whole.path}.result()));
  CHECK(dump(folder.result()).size() > 10000);
  const auto file = hdf5::open_file(folder.result());
  CHECK(hdf5::read(file, "times") == std::vector<double>{first.time, second.time, third.time});
  CHECK(hdf5::read(file, "history/time_s") == std::vector<double>{first.time, second.time, second.time, third.time});
}
