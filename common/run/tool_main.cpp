#include "common/run/tool_main.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <new>

#include "common/run/command_line.hpp"
#include "common/run/deadline.hpp"
#include "common/run/error.hpp"
#include "common/run/memory.hpp"
#include "common/run/messages.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/parallel.hpp"
#include "common/run/phases.hpp"
#include "common/run/pipe_failure.hpp"
#include "common/run/progress.hpp"
#include "common/run/removed_files.hpp"
#include "common/run/run_context.hpp"
#include "common/run/text_file.hpp"

// Defined only in builds with sanitizers, which give it this name and type.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" __attribute__((weak)) void __sanitizer_set_report_fd(void* descriptor);

namespace hexpipe {
namespace {

constexpr int exit_data = 1;
constexpr int exit_usage = 2;

// CLI11 writes the default of an option with several values as "[a,b]", given values as "a,b".
std::string default_value(const CLI::Option& option) {
  std::string text = option.get_default_str();
  if (text == "{}") return {};  // no values, as CLI11 2.4 writes them
  if (option.get_items_expected_max() > 1 && text.starts_with('[') && text.ends_with(']'))
    text = text.substr(1, text.size() - 2);
  return text;
}

// For a flag that switches something off, such as --no-reductions, CLI11 gives the value of what is switched off.
std::vector<std::string> given_values(const CLI::Option& option) {
  std::vector<std::string> values = option.results();
  if (option.check_fname(option.get_lnames().front()))
    for (std::string& value : values) value = value == "false" ? "true" : "false";
  return values;
}

nlohmann::ordered_json options_for_history(CLI::App& app) {
  nlohmann::ordered_json options = nlohmann::ordered_json::object();
  for (CLI::Option* const option : app.get_options({})) {
    if (option->get_lnames().empty() || options_outside_history().contains(option)) continue;
    // CLI11's join is not used: a stream without memory cuts its text off and says nothing.
    const std::string value =
        option->count() > 0 ? fmt::format("{}", fmt::join(given_values(*option), ",")) : default_value(*option);
    if (!value.empty()) options[option->get_lnames().front()] = value;
  }
  return options;
}

void declare_graph_file(CLI::App& app, GraphFileOptions& options) {
  begin_group(app, group::input);
  app.add_option("--graph-format", options.format,
                 "The format of a graph file [its first bytes tell; METIS if they do not]")
      ->check(one_of({"metis", "dimacs", "matrix-market", "edges"}));
  app.add_option("--weight-scale", options.weight_scale,
                 "Multiply the weights of a graph file, which may be any numbers, by this, then round")
      ->check(number_between(1e-300, 1e300));
  app.add_flag("--complement", options.complement,
               "Use the complement of the graph file: its cliques become the independent sets");
  app.add_flag("--tolerant", options.tolerant, "Ignore loops and repeated edges of a graph file, with a warning");
}

// Options of tools that write meshes. None of them changes a bundle.
void declare_mesh_output(CLI::App& app, Role product, MeshOptions& mesh) {
  outside_history(
      app.add_option("--solver", mesh.solver,
                     "Write pyramids, hexes and facets in the way that suits this program; calculix: pyramids "
                     "collapsed, C3D8I; abaqus: C3D8I; openfoam, su2, nastran, moose: their format is checked; "
                     "code-aster: names of 24 characters; dealii: no facets between regions"))
      ->group(product == Role::result ? group::first : group::output)
      ->type_name("NAME")
      ->check(one_of({"calculix", "abaqus", "openfoam", "su2", "nastran", "moose", "code-aster", "dealii"}));
  outside_history(
      app.add_option(
          "--pyramids", mesh.pyramids,
          "How other formats get pyramids: keep; collapsed: as hexes with the apex four times (.inp); split: as two "
          "tets each, of second order as four"))
      ->type_name("FORM")
      ->check(one_of({"keep", "collapsed", "split"}));
  outside_history(app.add_option("--hex-element", mesh.hex_element, "The type of hexes in .inp: C3D8, C3D8I or C3D8R"))
      ->type_name("TYPE")
      ->check(one_of({"C3D8", "C3D8I", "C3D8R"}));
  outside_history(
      app.add_option(
          "--polyhedra", mesh.polyhedra,
          "In a polyMesh, mend: where OpenFOAM's checkMesh finds fault, cells are halved or merge to polyhedra, "
          "vertices move, and flat cells at the boundary are left out; none: cells stay as they are [mend]"))
      ->type_name("HOW")
      ->check(one_of({"mend", "none"}));
  outside_history(app.add_flag("--no-facets", mesh.no_facets,
                               "Leave facets out of other formats, for readers that take only cells"));
}

void declare_streams(CLI::App& app, RunContext& context) {
  StreamOptions& streams = context.streams;
  const auto& reads = context.info.reads;
  begin_group(app, group::input);
  if (!reads.empty()) {
    app.add_option("input", streams.operand,
                   fmt::format("A bundle, or the {} in any format; standard input if it is '-' or missing",
                               name_of(reads.front())))
        ->type_name("FILE");
    for (const Role role : reads)
      outside_history(
          app.add_option(fmt::format("--{}", name_of(role)), streams.files[role],
                         fmt::format("Take the {} from this file, even if the bundle has one", name_of(role))))
          ->type_name("FILE");
  }
  if (std::ranges::find(reads, Role::graph) != reads.end()) declare_graph_file(app, streams.graph_file);
  if (!context.info.product) return;
  outside_history(
      app.add_option("-o,--output", streams.output,
                     fmt::format("Write to a file: a bundle (.tar, .tar.zst), or only the {}, in the format that "
                                 "the ending names",
                                 name_of(*context.info.product))))
      ->group(group::first)
      ->type_name("FILE");
  begin_group(app, group::output);
  outside_history(
      app.add_option("--format", streams.format, "The format of the output; it overrides the ending of its name"))
      ->type_name("NAME");
  outside_history(app.add_flag("--compress", streams.compress, "Compress the bundle with zstd"));
  if (*context.info.product == Role::solution)
    outside_history(
        app.add_flag("--slim", streams.slim,
                     "Leave the conflicts out of the bundle, most of its bytes: assemble and viewmesh do not "
                     "read them; certify and further searches need them"));
  if (*context.info.product == Role::mesh || *context.info.product == Role::result)
    declare_mesh_output(app, *context.info.product, streams.mesh);
}

void declare_common(CLI::App& app, RunContext& context) {
  CommonOptions& common = context.common;
  const ToolInfo& info = context.info;
  begin_group(app, group::run);
  outside_history(app.add_option("--threads", common.threads, "Threads to use; 0: all that the machine has"))
      ->check(whole_number_between(0, 4096))
      ->capture_default_str();
  outside_history(
      app.add_option("--memory", common.memory, "Use at most this much memory, such as 8G [what the machine has left]"))
      ->type_name("BYTES")
      ->transform(CLI::AsSizeValue(false).description(""))
      ->check(enough_memory());
  if (info.random)
    app.add_option("--seed", common.seed, "Seed of the random numbers")
        ->type_name("N")
        ->check(whole_number_of_64_bits())
        ->capture_default_str();
  if (info.searches) {
    const std::string note = info.default_time_limit
                                 ? fmt::format(" [{:g} unless --iterations is given]", *info.default_time_limit)
                             : info.ends_by_itself.empty() ? std::string()
                                                           : fmt::format(" [it ends {}]", info.ends_by_itself);
    app.add_option("--time-limit", common.time_limit, "Stop after this many seconds" + note)
        ->group(group::first)
        ->type_name("SECONDS")
        ->check(number_between(0, 1e9));
    app.add_option("--iterations", common.iterations, "Stop after this many iterations")
        ->type_name("N")
        ->check(whole_number_between(0, std::int64_t{1} << 62).description(""));
    outside_history(
        app.add_option("--log", common.log_file,
                       "Write the course of the search to a file, one JSON object per line; '-': to standard output"))
        ->type_name("FILE");
  }
  outside_history(
      app.add_option("--stats", common.stats_file, "Write counts and times to a file as JSON; '-': to standard output"))
      ->type_name("FILE");
  outside_history(app.add_flag("-v,--verbose", common.verbose, "Report what is done, on standard error"));
  outside_history(app.add_flag("-q,--quiet", common.quiet, "Only errors: no progress, no warnings"));
  outside_history(app.set_config("--config", "", "Read options from a file (name=value)"))->type_name("FILE");
  app.allow_config_extras(CLI::config_extras_mode::error);
}

std::string footer(const ToolInfo& info) {
  return fmt::format(
      "\nExample:\n  {}\n\nExit codes: 0 done, 1 bad data or failed input or output, 2 bad command line.",
      info.example);
}

// Checked before the run, so that hours of work do not end in an error. An existing file stays as it is.
void check_writable(const std::string& path) {
  if (path.empty() || path == "-") return;
  const bool is_new = access(path.c_str(), F_OK) != 0;
  const std::size_t slash = path.rfind('/');
  const std::string directory = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  if (access(is_new ? directory.c_str() : path.c_str(), W_OK) != 0)
    throw DataError::at(path, "cannot write: {}", std::strerror(errno));
}

// `seconds` are the tool's own, without those that it waited for its neighbours in a pipe.
void write_statistics(const RunContext& context, double seconds) {
  if (context.common.stats_file.empty()) return;
  nlohmann::ordered_json statistics{{"tool", context.info.name}};
  statistics.update(context.statistics);
  statistics["seconds"] = seconds;
  TextFile file(context.common.stats_file);
  file.write(statistics.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
  file.close();
}

// If the caller closed a standard stream, the next file opened would take its place, and messages would land in the
// data. This puts a stream there on which reading and writing fail.
void keep_standard_streams_apart() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0) open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

int report(const std::string& tool, std::string_view message, int code) {
  print_message(tool, message);
  mark_pipes_as_failed();
  return code;
}

// Bad data, or failed input or output. If a neighbour in the pipe failed, it has said why.
int report_failure(const std::string& tool, std::string_view message) {
  if (reader_has_failed()) {
    mark_pipes_as_failed();
    // As programs end whose reader has gone.
    signal(SIGPIPE, SIG_DFL);
    raise(SIGPIPE);
  }
  if (!writer_has_failed()) return report(tool, message, exit_data);
  mark_pipes_as_failed();
  return exit_data;
}

// The standard streams hold nothing but help, and show() has checked that it was written.
void end_at_once(int code, void*) {
  std::cout.flush();
  std::fflush(nullptr);
  _exit(code);
}

// Ends the process after main() without the destructors of libraries, which do nothing useful here: OpenBLAS's waits
// for threads that keep trying to allocate memory that --memory does not leave them. The sanitizers search for leaks in
// these destructors, so their builds run them.
void leave_libraries_out_at_exit() {
  static const bool sanitized = __sanitizer_set_report_fd != nullptr;
  static const int registered = sanitized ? 0 : on_exit(end_at_once, nullptr);
  static_cast<void>(registered);
}

// --help and --version.
int show(const CLI::App& app, const CLI::Success& text, const ToolInfo& info) {
  app.exit(text);
  if (std::cout.flush()) return 0;
  return report(info.name, fmt::format("stdout: cannot write: {}", std::strerror(errno)), exit_data);
}

[[noreturn]] void end_without_memory();

// Installed before main(); the usual handler remains responsible for everything except missing memory.
const std::terminate_handler usual_end = std::set_terminate(end_without_memory);

// Memory may also run out where no exception can pass: in a destructor, or before tool_main.
void end_without_memory() {
  try {
    if (const std::exception_ptr current = std::current_exception()) std::rethrow_exception(current);
  } catch (const std::bad_alloc&) {
    dprintf(STDERR_FILENO, "%s: not enough memory\n", program_invocation_short_name);
    remove_registered_files();
    mark_pipes_as_failed();
    _exit(exit_data);
  } catch (...) {
    usual_end();
  }
  std::abort();
}

}  // namespace

int tool_main(int argc, char** argv, const ToolInfo& info, const std::function<void(CLI::App&)>& declare,
              const std::function<void(RunContext&)>& run) {
  keep_standard_streams_apart();
  leave_libraries_out_at_exit();
  install_signal_handlers();
  if (info.searches) stop_searches_on_signal();

  RunContext context;
  context.info = info;
  options_outside_history().clear();
  CLI::App app(info.summary, info.name);
  app.formatter(std::make_shared<HelpFormatter>());
  outside_history(app.get_help_ptr())->group(group::run);
  outside_history(app.set_version_flag("--version",
                                       fmt::format("{} (hexpipe) {}\nLicence: {}", info.name, version(), info.licence)))
      ->group(group::run);
  app.footer(footer(info));
  app.option_defaults()->always_capture_default();
  declare(app);
  app.option_defaults()->always_capture_default(false);
  declare_streams(app, context);
  declare_common(app, context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return show(app, success, info);
  } catch (const CLI::ParseError& error) {
    return report(info.name, explanation_of(app, error), exit_usage);
  }
  std::erase_if(context.streams.files, [](const auto& file) { return file.second.empty(); });
  context.options = options_for_history(app);

  try {
    check_named_files(app);
    if (context.common.memory) limit_memory(*context.common.memory);
    ThreadLimit(context.common.threads).stay();
    check_writable(context.common.stats_file);
    const Stopwatch watch;
    {
      const ProgressLine line(info.name, context.common.quiet);
      run(context);
    }
    write_statistics(context, watch.seconds() - seconds_waited());
    return 0;
  } catch (const UsageError& error) {
    return report(info.name, error.what(), exit_usage);
  } catch (const std::bad_alloc&) {
    return report(info.name, "not enough memory", exit_data);
  } catch (const std::exception& error) {
    return report_failure(info.name, error.what());
  }
}

}  // namespace hexpipe
