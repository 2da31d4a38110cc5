// What a run has written when the disc refuses more, when its process is killed, and when the folder is not its own.
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <random>

#include "output/fields.hpp"
#include "output/recorder.hpp"
#include "output_state.hpp"
#include "result_file.hpp"

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

// Requires that the fields of an output time are all in a file.
void require_whole(const std::filesystem::path& path, std::size_t k) {
  const auto file = hdf5::open_file(path);
  REQUIRE(hdf5::number_attribute(file, fmt::format("particles/{:05}", k), "time_s") == 0.1 * static_cast<double>(k));
  for (const char* field : {"x_m", "s_xy_Pa", "rock"}) {
    REQUIRE(hdf5::read(file, fmt::format("particles/{:05}/{}", k, field)).size() == made_state().particles.size());
  }
  REQUIRE(hdf5::read(file, fmt::format("fracture/{:05}/pressure_Pa", k)) == made_state().fluid.P);
  REQUIRE(file.nameExists(fmt::format("interfaces/{:05}", k)));
}

}  // namespace

TEST_CASE("a disc that is full at any byte leaves no fields that are torn, and takes them when there is room") {
  const TemporaryFolder temporary;
  const RunFolder folder{temporary.path};
  const Recorder recorder(folder);
  std::size_t failed = 0;
  for (std::uint64_t bytes = 1; bytes < 60000; bytes += 997) {
    bool full = false;
    {
      const Limit limit(bytes);
      try {
        write_fields(folder, 0, made_scene(), state_at(0));
      } catch (const OutputFailure& failure) {
        full = true;
        REQUIRE_THAT(failure.what(), Catch::Contains("cannot be written: File too large"));
      }
    }
    if (!full) break;
    ++failed;
    REQUIRE(std::filesystem::is_empty(folder.all_fields()));
  }
  CHECK(failed > 10);
  require_whole(folder.fields(0), 0);
}

// Requires that a disc that is full when the fields are gathered leaves what was gathered before, byte for byte, and
// that what is gathered says the same as the files of the output times.
TEST_CASE("fields are gathered in one file as a whole or not at all") {
  const TemporaryFolder temporary;
  const RunFolder folder{temporary.path};
  Recorder recorder(folder);
  recorder.output(made_scene(), state_at(0));
  recorder.gather();
  const std::string before = content_of(folder.result());
  for (int k = 1; k < 3; ++k) recorder.output(made_scene(), state_at(k));
  for (const std::uint64_t bytes : {std::uint64_t{100}, std::uint64_t{before.size() + 1000}, std::uint64_t{60000}}) {
    const Limit limit(bytes);
    CHECK_THROWS_WITH(recorder.gather(), Catch::Contains("cannot be written: File too large"));
    CHECK(content_of(folder.result()) == before);
    CHECK_FALSE(std::filesystem::exists(temporary.path / "result.h5.tmp"));
  }
  recorder.gather();
  for (std::size_t k = 0; k < 3; ++k) {
    require_whole(folder.result(), k);
    require_whole(folder.fields(k), k);
  }
  CHECK(hdf5::read(hdf5::open_file(folder.result()), "times") == recorder.written().output_times);
}

TEST_CASE("fields that are gone end the run with the reason") {
  const TemporaryFolder temporary;
  const RunFolder folder{temporary.path};
  Recorder recorder(folder);
  recorder.output(made_scene(), state_at(0));
  std::filesystem::remove_all(folder.all_fields());
  CHECK_THROWS_AS(recorder.gather(), OutputFailure);
  CHECK_THROWS_WITH(Recorder(folder, recorder.written()), Catch::Contains("00000.h5: is missing"));  // starts anew
  std::filesystem::remove_all(folder.all_fields());
  CHECK_THROWS_WITH(recorder.output(made_scene(), state_at(1)), Catch::Contains("No such file or directory"));
  CHECK(recorder.written().output_times.size() == 1);
  CHECK_THROWS_WITH(Recorder(RunFolder{"/proc/nowhere"}), Catch::Contains("/proc/nowhere"));
}

TEST_CASE("fields and a history can be read whenever the writing process was killed") {
  std::mt19937 random(1);
  std::size_t most = 0, least = 1000;
  for (int trial = 0; trial < 60; ++trial) {
    const TemporaryFolder folder;
    const RunFolder files{folder.path};
    const pid_t child = ::fork();
    if (child == 0) {
      Recorder recorder(files);
      for (int k = 0;; ++k) recorder.output(made_scene(), state_at(k));
    }
    while (!std::filesystem::exists(files.history())) ::usleep(50);
    ::usleep(std::uniform_int_distribution<unsigned>(0, 20000)(random));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    std::size_t outputs = 0;
    for (; std::filesystem::exists(files.fields(outputs)); ++outputs) require_whole(files.fields(outputs), outputs);
    // The kernel ends a write between two pages where the process is killed: the last row may be cut short.
    const std::string history = content_of(files.history());
    const auto rows = static_cast<std::size_t>(std::ranges::count(history, '\n')) - 1;
    REQUIRE(history.starts_with(history_header()));
    REQUIRE(rows >= outputs);
    REQUIRE(rows <= outputs + 1);
    most = std::max(most, outputs), least = std::min(least, outputs);
  }
  CHECK(most > least);
}

TEST_CASE("a row that the disc refuses is not half there; a history that is gone or changed is noticed") {
  const TemporaryFolder folder;
  const auto file = folder.path / "history.csv";
  Recorder recorder(RunFolder{folder.path});
  const auto append = [&] { recorder.row(made_scene(), state_at(1)); };
  append();
  const std::string before = content_of(file);
  for (const std::uint64_t more : std::initializer_list<std::uint64_t>{0, 1, 20, 40}) {
    const Limit limit(before.size() + more);
    CHECK_THROWS_WITH(append(), Catch::Contains("history.csv: cannot be written"));
    CHECK(content_of(file) == before);
  }
  CHECK(recorder.written().rows.size() == 1);
  append();
  const std::string two = content_of(file);
  CHECK(two == before + history_line(recorder.written().rows[1]));
  std::ofstream(file, std::ios::app) << "x";
  CHECK_THROWS_WITH(append(), Catch::Contains("another program has changed it"));
  std::filesystem::remove(file);
  CHECK_THROWS_WITH(append(), Catch::Contains("No such file or directory"));
  CHECK_FALSE(std::filesystem::exists(file));
  Recorder(RunFolder{folder.path}, recorder.written());  // what goes on has it again
  CHECK(content_of(file) == two);
}

TEST_CASE("a checkpoint that the disc refuses leaves the one before") {
  const TemporaryFolder folder;
  const RunFolder files{folder.path};
  Recorder recorder(files);
  recorder.output(made_scene(), state_at(0));
  recorder.checkpoint(made_scene(), {state_at(0), recorder.written()});
  const std::string before = content_of(files.checkpoint());
  {
    const Limit limit(before.size() - 1);
    CHECK_THROWS_AS(recorder.checkpoint(made_scene(), {state_at(1), recorder.written()}), OutputFailure);
  }
  CHECK(content_of(files.checkpoint()) == before);
  CHECK_FALSE(std::filesystem::exists(folder.path / "checkpoint.bin.tmp"));
}

TEST_CASE("a folder that holds a run is refused unless it is to be replaced, which spares what is no run's") {
  const TemporaryFolder temporary;
  const auto path = temporary.path / "runs" / "exp1";
  const RunFolder folder{path};
  make_folder(path);
  atomic_write(path / "notes.txt", "text");
  CHECK_NOTHROW(clear_run_folder(folder, false));
  for (const auto& file :
       {folder.scene(), folder.summary(), folder.history(), folder.result(), folder.xdmf(), folder.checkpoint()}) {
    atomic_write(file, "text");
    CHECK_THROWS_WITH(clear_run_folder(folder, false), Catch::Contains("holds a run already") &&
                                                           Catch::Contains("strata resume") &&
                                                           Catch::Contains("--replace"));
    CHECK(content_of(file) == "text");
    clear_run_folder(folder, true);
    CHECK(std::filesystem::exists(file) == (file == folder.scene()));  // the new one takes its place in one piece
    std::filesystem::remove(file);
  }
  for (const char* left : {"summary.json.tmp", "result.h5.tmp", "result.h5.fields"}) {
    atomic_write(path / left, "text");
    clear_run_folder(folder, false);
    CHECK_FALSE(std::filesystem::exists(path / left));
  }
  CHECK(content_of(path / "notes.txt") == "text");
  CHECK_THROWS_WITH(make_folder(path / "notes.txt" / "a"), Catch::Contains("cannot be made"));
  CHECK_THROWS_WITH(make_folder(path / "notes.txt"), Catch::Contains("notes.txt"));
}

TEST_CASE("a folder has one writer, until that is gone") {
  const TemporaryFolder folder;
  {
    const fmt::file lock = lock_folder(folder.path);
    CHECK_THROWS_WITH(lock_folder(folder.path), Catch::Contains("in use by a run"));
  }
  CHECK_NOTHROW(lock_folder(folder.path));
  CHECK_THROWS_AS(lock_folder(folder.path / "none"), OutputFailure);
}
