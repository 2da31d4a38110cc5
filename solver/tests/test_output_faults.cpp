// What a run has written when the disc refuses more, when its process is killed, and when the folder is not its own.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <random>

#include <fmt/format.h>

#include <fstream>

#include "output/hdf5_io.hpp"
#include "output/recorder.hpp"
#include "output_state.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// No file may grow beyond `bytes` while this lives, as on a disc that is full.
class Limit {
 public:
  explicit Limit(std::uint64_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &now) == 0);
  }
  Limit(const Limit&) = delete;
  Limit& operator=(const Limit&) = delete;
  ~Limit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

State state_at(int k) {
  State state = made_state();
  state.time = 0.1 * k;
  return state;
}

// Times in the file; all that belongs to them is read.
std::vector<double> whole_times(const std::filesystem::path& path) {
  const auto file = hdf5::open_file(path);
  std::vector<double> times = hdf5::read(file.id(), "times");
  for (const char* kind : {"particles", "fracture", "interfaces"}) {
    REQUIRE(hdf5::names(hdf5::group(file.id(), kind).id()).size() == times.size());
  }
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::string number = fmt::format("particles/{:05}", k);
    REQUIRE(hdf5::number_attribute(file.id(), number, "time_s") == times[k]);
    for (const char* field : {"x_m", "s_xy_Pa", "rock"}) {
      REQUIRE(hdf5::read(file.id(), number + "/" + field).size() == made_state().particles.size());
    }
    REQUIRE(hdf5::read(file.id(), fmt::format("fracture/{:05}/pressure_Pa", k)) == made_state().fluid.P);
  }
  return times;
}

}  // namespace

TEST_CASE("a disc that is full at any byte leaves the result file as it was, and it goes on when there is room") {
  const TemporaryFolder folder;
  const auto path = folder.path / "result.h5";
  ResultFile result(path);
  result.write_output(made_scene(), state_at(0));
  const std::string before = content_of(path);
  ResultFile(folder.path / "other.h5");
  std::size_t failed = 0;
  for (std::uint64_t bytes = 1; bytes < before.size() + 60000; bytes += 997) {
    bool full = false;
    {
      const Limit limit(bytes);
      try {
        result.write_output(made_scene(), state_at(1));
      } catch (const OutputFailure& failure) {
        full = true;
        REQUIRE_THAT(failure.what(), Catch::Contains("cannot be written: File too large"));
      }
    }
    if (!full) break;
    ++failed;
    REQUIRE(result.outputs() == 1);
    REQUIRE(content_of(path) == before);
    REQUIRE_FALSE(std::filesystem::exists(folder.path / "result.h5.tmp"));
    REQUIRE_FALSE(std::filesystem::exists(folder.path / "result.h5.fields" / "00001.h5.tmp"));
  }
  CHECK(failed > 20);
  CHECK(whole_times(path) == std::vector<double>{0.0, 0.1});
  CHECK(result.outputs() == 2);
}

// Requires that a disc that is full when the fields are gathered leaves the file that refers to them, byte for byte,
// and that what is gathered says the same without them.
TEST_CASE("fields are gathered in one file as a whole or not at all") {
  const TemporaryFolder folder;
  const auto path = folder.path / "result.h5";
  ResultFile result(path);
  for (int k = 0; k < 3; ++k) result.write_output(made_scene(), state_at(k));
  const std::string before = content_of(path);
  for (const std::uint64_t bytes : {std::uint64_t{100}, std::uint64_t{before.size() + 1000}, std::uint64_t{60000}}) {
    const Limit limit(bytes);
    CHECK_THROWS_WITH(result.finish({}), Catch::Contains("result.h5.tmp: cannot be written: File too large"));
    CHECK(content_of(path) == before);
    CHECK_FALSE(std::filesystem::exists(folder.path / "result.h5.tmp"));
  }
  CHECK(whole_times(path) == std::vector<double>{0.0, 0.1, 0.2});
  result.finish({});
  CHECK_FALSE(std::filesystem::exists(fields_of(path)));
  CHECK(whole_times(path) == std::vector<double>{0.0, 0.1, 0.2});
}

TEST_CASE("fields that are gone, or a result file that is, end the run with the reason") {
  const TemporaryFolder folder;
  const auto path = folder.path / "result.h5";
  ResultFile result(path);
  result.write_output(made_scene(), state_at(0));
  std::filesystem::rename(fields_of(path), folder.path / "elsewhere");
  CHECK_THROWS_AS(result.finish({}), OutputFailure);
  CHECK_THROWS_WITH(result.write_output(made_scene(), state_at(1)), Catch::Contains("No such file or directory"));
  CHECK_THROWS_AS(ResultFile(path, 1), std::runtime_error);  // the run starts anew
  std::filesystem::rename(folder.path / "elsewhere", fields_of(path));
  std::filesystem::remove(path);
  CHECK_THROWS_AS(result.write_output(made_scene(), state_at(1)), OutputFailure);
  CHECK_THROWS_AS(result.finish({}), OutputFailure);
  CHECK(result.outputs() == 1);
}

TEST_CASE("a result file and a history can be read whenever the writing process was killed") {
  std::mt19937 random(1);
  std::size_t most = 0, least = 1000;
  for (int trial = 0; trial < 60; ++trial) {
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
      Recorder recorder(RunFolder{folder.path});
      for (int k = 0;; ++k) recorder.output(made_scene(), state_at(k));
    }
    const RunFolder files{folder.path};
    while (!std::filesystem::exists(files.xdmf())) ::usleep(50);
    ::usleep(std::uniform_int_distribution<unsigned>(0, 20000)(random));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const std::vector<double> times = whole_times(files.result());
    for (std::size_t k = 0; k < times.size(); ++k) REQUIRE(times[k] == 0.1 * static_cast<int>(k));
    // The kernel ends a write between two pages where the process is killed: a row may be cut short, as a checkpoint's
    // mark of the history allows for.
    std::filesystem::resize_file(files.history(), content_of(files.history()).rfind('\n') + 1);
    const std::size_t rows = read_history(files.history()).size();
    REQUIRE(rows >= times.size());
    REQUIRE(rows <= times.size() + 1);
    REQUIRE(ResultFile(files.result(), times.size()).outputs() == times.size());
    most = std::max(most, times.size()), least = std::min(least, times.size());
  }
  CHECK(most > least);
}

TEST_CASE("a row that the disc refuses is not half there; a history that is gone or changed is noticed") {
  const TemporaryFolder folder;
  const auto file = folder.path / "history.csv";
  HistoryWriter writer(file);
  const HistoryRow row(history_columns().size());
  writer.append(row);
  const std::string before = content_of(file);
  for (const std::uint64_t more : std::initializer_list<std::uint64_t>{0, 1, 20, 40}) {
    const Limit limit(before.size() + more);
    CHECK_THROWS_WITH(writer.append(row), Catch::Contains("history.csv: cannot be written"));
    CHECK(content_of(file) == before);
  }
  CHECK(writer.rows().size() == 1);
  writer.append(row);
  CHECK(read_history(file).size() == 2);
  std::ofstream(file, std::ios::app) << "x";
  CHECK_THROWS_WITH(writer.append(row), Catch::Contains("another program has changed it"));
  std::filesystem::remove(file);
  CHECK_THROWS_WITH(writer.append(row), Catch::Contains("No such file or directory"));
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("a checkpoint that the disc refuses leaves the one before") {
  const TemporaryFolder folder;
  const RunFolder files{folder.path};
  Recorder recorder(files);
  recorder.output(made_scene(), state_at(0));
  recorder.checkpoint(made_scene(), state_at(0), recorder.mark());
  const std::string before = content_of(files.checkpoint());
  {
    const Limit limit(before.size() - 1);
    CHECK_THROWS_AS(recorder.checkpoint(made_scene(), state_at(1), recorder.mark()), OutputFailure);
  }
  CHECK(content_of(files.checkpoint()) == before);
  CHECK_FALSE(std::filesystem::exists(folder.path / "checkpoint.bin.tmp"));
}

TEST_CASE("a folder that holds a run is refused unless it is to be replaced, which spares what is no run's") {
  const TemporaryFolder temporary;
  const auto path = temporary.path / "runs" / "exp1";
  { const Descriptor lock = make_run_folder(path); }
  const RunFolder folder = clear_run_folder(path, false);
  atomic_write(path / "notes.txt", "text");
  CHECK_NOTHROW(clear_run_folder(path, false));
  for (const auto& file :
       {folder.scene(), folder.summary(), folder.history(), folder.result(), folder.xdmf(), folder.checkpoint()}) {
    atomic_write(file, "text");
    CHECK_THROWS_WITH(clear_run_folder(path, false), Catch::Contains("holds a run already") &&
                                                         Catch::Contains("strata resume") &&
                                                         Catch::Contains("--replace"));
    CHECK(content_of(file) == "text");
    clear_run_folder(path, true);
    CHECK(std::filesystem::exists(file) == (file == folder.scene()));  // the new one takes its place in one piece
    std::filesystem::remove(file);
  }
  for (const char* left : {"summary.json.tmp", "result.h5.tmp", "result.h5.fields"}) {
    atomic_write(path / left, "text");
    clear_run_folder(path, false);
    CHECK_FALSE(std::filesystem::exists(path / left));
  }
  CHECK(content_of(path / "notes.txt") == "text");
  CHECK_THROWS_WITH(make_run_folder(path / "notes.txt" / "a"), Catch::Contains("cannot be made"));
  CHECK_THROWS_WITH(make_run_folder(path / "notes.txt"), Catch::Contains("notes.txt"));
}

TEST_CASE("a folder has one writer, until that is gone") {
  const TemporaryFolder folder;
  {
    const Descriptor lock = lock_folder(folder.path);
    CHECK_THROWS_WITH(lock_folder(folder.path), Catch::Contains("in use by a run"));
  }
  CHECK_NOTHROW(lock_folder(folder.path));
  CHECK_THROWS_AS(lock_folder(folder.path / "none"), OutputFailure);
}
