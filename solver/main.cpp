// The command line: read a scene, run it, and say by the exit status how it went.
#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "output/run_folder.hpp"
#include "output/summary.hpp"
#include "run.hpp"
#include "scene/derived.hpp"
#include "scene/keys.hpp"
#include "scene/messages.hpp"
#include "scene/new_scene.hpp"
#include "scene/toml_reader.hpp"
#include "scene/well_log.hpp"

namespace {

constexpr int done = 0, bug = 1, bad_input = 2;

struct Arguments {
  std::string file;                // scene, or folder of a run
  std::vector<std::string> files;  // of check
  std::string variant;
  std::vector<std::string> set;
  strata::RunOptions options;
};

int report(const std::vector<std::string>& errors) {
  constexpr std::size_t longest = 2000;  // of a path that no system takes, or of an argument
  for (const std::string& error : errors)
    strata::tell("{}\n", strata::error_in_colour(strata::shortened(error, longest)));
  return errors.empty() ? done : bad_input;
}

int run(Arguments arguments) {
  const std::filesystem::path file = arguments.file;
  const strata::ReadResult read = strata::read_scene_that_fits(file, arguments.variant, arguments.set);
  if (!read.scene) return report(read.errors);
  if (!arguments.options.quiet) report(read.notes);
  const std::string folder = arguments.variant.empty() ? "default" : arguments.variant;
  if (arguments.options.out.empty()) arguments.options.out = std::filesystem::path("runs") / file.stem() / folder;
  return strata::run_scene(*read.scene, arguments.options);
}

int resume(const Arguments& arguments) {
  const std::filesystem::path dir = arguments.file;
  std::error_code error;
  if (std::filesystem::exists(dir / "scene.toml", error)) return strata::resume_run(dir, arguments.options);
  return report({dir.string() + ": this is not the folder of a run; it holds no scene.toml."});
}

int resolve(const Arguments& arguments) {
  const strata::ReadResult read = strata::read_scene(arguments.file, arguments.variant, arguments.set);
  if (read.scene) fmt::print("{}", read.scene->resolved_toml);
  return report(read.errors);
}

int check(const Arguments& arguments) {
  int status = done;
  for (const std::string& file : arguments.files) {
    const strata::ReadResult read = strata::check(file);
    if (report(read.errors) != done) {
      status = bad_input;
      continue;
    }
    report(read.notes);
    fmt::print("{}: {}\n", file, strata::announce(*read.scene));
  }
  return status;
}

int list_sweep(const Arguments& arguments) {
  strata::Found runs = strata::of_file(arguments.file, strata::list_sweep);
  if (runs.errors.empty() && runs.lines.empty()) runs.errors.push_back(arguments.file + ": the scene has no [sweep].");
  if (runs.errors.empty()) fmt::print("runs = [\n  {},\n]\n", fmt::join(runs.lines, ",\n  "));
  return report(runs.errors);
}

int print(const strata::Found& found) {
  for (const std::string& line : found.lines) fmt::print("{}\n", line);
  return report(found.errors);
}

int parse_and_do(int argc, char** argv) {
  CLI::App app{"Hydraulic fractures in layered rock: a verification-first testbed", "strata"};
  Arguments arguments;
  app.set_version_flag("--version", strata::version());
  app.require_subcommand(1);
  CLI::App* run_command = app.add_subcommand("run", "run a scene");
  CLI::App* resolve_command = app.add_subcommand("resolve", "the scene that a run would write to scene.toml");
  for (CLI::App* command : {run_command, resolve_command}) {
    command->add_option("scene", arguments.file, "scene file")->required();
    command->add_option("--variant", arguments.variant, "one of the scene's variants");
    command->add_option("--set", arguments.set, "key.path=value; acts after the variant")->allow_extra_args(false);
  }
  run_command->add_option("--out", arguments.options.out, "folder of the run; by default runs/SCENE/VARIANT");
  run_command->add_flag("--replace", arguments.options.replace, "in place of a run that the folder holds");
  CLI::App* check_command =
      app.add_subcommand("check", "all errors of scenes, variants and sweeps, or what a run says first; nothing run");
  check_command->add_option("scenes", arguments.files, "scene files")->required();
  CLI::App* variants_command = app.add_subcommand("variants", "names of a scene's variants, one a line");
  variants_command->add_option("scene", arguments.file, "scene file")->required();
  CLI::App* sweep_command =
      app.add_subcommand("sweep", "runs of a scene's [sweep] as TOML, one a line: name, settings");
  sweep_command->add_option("scene", arguments.file, "scene file")->required();
  CLI::App* resume_command = app.add_subcommand("resume", "go on with a run from its last checkpoint");
  resume_command->add_option("dir", arguments.file, "folder of the run")->required();
  for (CLI::App* command : {run_command, resume_command}) {
    command->add_option("--threads", arguments.options.threads, "threads; 0, the default, for all cores")
        ->check(CLI::NonNegativeNumber);
    command
        ->add_option("--checkpoint-every", arguments.options.checkpoint_every_s,
                     "seconds from one checkpoint to the next; 60 by default")
        ->check(CLI::NonNegativeNumber);
    command->add_flag("--quiet", arguments.options.quiet, "no progress on the terminal");
  }
  CLI::App* log_command = app.add_subcommand("log", "a scene of a well log, to be looked over");
  log_command->add_option("csv", arguments.file, strata::log_help())->required();
  CLI::App* new_command = app.add_subcommand("new", "write a scene to start from, with what each of its keys means");
  new_command->add_option("name", arguments.file, "name of the scene; its file is NAME.toml")->required();
  CLI::App* keys_command = app.add_subcommand("keys", "all keys of a scene as a table in Markdown");
  app.set_help_all_flag("--help-all", "the help of all commands");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, wrong;
    const int status = app.exit(error, out, wrong);
    fmt::print("{}", out.str());
    return status == 0 ? done : report({wrong.str().substr(0, wrong.str().find_last_not_of('\n') + 1)});
  }
  if (run_command->parsed()) return run(arguments);
  if (check_command->parsed()) return check(arguments);
  if (resolve_command->parsed()) return resolve(arguments);
  if (variants_command->parsed()) return print(strata::of_file(arguments.file, strata::list_variants));
  if (sweep_command->parsed()) return list_sweep(arguments);
  if (log_command->parsed()) return print(strata::of_file(arguments.file, strata::scene_of_log));
  if (resume_command->parsed()) return resume(arguments);
  if (new_command->parsed()) return report(strata::write_new_scene(arguments.file));
  if (keys_command->parsed()) fmt::print("{}", strata::keys_as_markdown());
  return done;
}

// Without inertia, matrices of tens of MB come and go with each increment of the fracture. Given back to the system and
// taken anew, their pages alone took 12 % of Experiment 5 soft at 0.25 m.
void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  try {
    return parse_and_do(argc, argv);
  } catch (const strata::OutputFailure& failure) {
    return report({failure.what()});
  } catch (const std::bad_alloc&) {
    strata::tell(
        "strata: out of memory: the machine, or a limit set for this process, gives no more. Use larger cells.\n");
    return bad_input;
  } catch (const std::exception& error) {
    strata::tell("strata: a bug: {}\n", error.what());
    return bug;
  }
}
