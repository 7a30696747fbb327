// The program in WebAssembly: `main`, the command `read` for JavaScript, and what the program needs of an
// operating system where there is none. JavaScript ends a run by ending its worker (web/package/api.js), so
// nothing waits for signals.

#include "program.hpp"

#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/plate.hpp"

#include "command_line.hpp"
#include "commands.hpp"
#include "crash.hpp"
#include "figures.hpp"
#include "heap.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "standard_streams.hpp"
#include "worker_team.hpp"

#include <emscripten/emscripten.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

/// Calls `Module.ended`, whose caller ends all threads if some may be at work (web/library.js).
extern "C" void lamella_ended(int exit_code, int at_work);

namespace lamella::app {

Interrupt::Interrupt(const Messages& messages, Interrupts kind) : messages_(messages), watch_(kind) {}
Interrupt::~Interrupt() = default;

/// Only threads that watch others call this (--timeout).
void leave_at_once(std::string_view last_words, int exit_code) noexcept {
    std::fwrite(last_words.data(), 1, last_words.size(), stderr);
    std::fflush(stderr);
    lamella_ended(exit_code, 1);
    for (;;)
        std::this_thread::sleep_for(std::chrono::hours(1));
}

void report_crashes(ProgressStyle /*style*/) noexcept {}

void keep_freed_memory() noexcept {}
void return_freed_memory() noexcept {}

WorkerTeam::WorkerTeam(std::size_t /*size*/, Work /*work*/, std::string /*introduction*/) {
    throw Error(ErrorKind::usage,
                "--batch starts processes, and there are none in WebAssembly: slice the files one by one");
}
WorkerTeam::~WorkerTeam() = default;
void WorkerTeam::start(const WorkerTask& /*task*/) {}
void WorkerTeam::stop() noexcept {}
bool WorkerTeam::is_busy() const noexcept {
    return false;
}
std::vector<WorkerAnswer> WorkerTeam::wait() {
    return {};
}
std::optional<std::string> introduction_to_worker() {
    return std::nullopt;
}

namespace {

struct ReadArguments {
    std::string input;
    PlacementOptions placement; ///< only the unit is used
    ReadLimits limits;
    RunOptions run;
};

Json described(const MeshFile& file, const Plate& plate) {
    Json bodies = Json::array();
    for (const PlatePart& part : plate.parts)
        bodies.push_back({{"label", part.label}, {"support", part.support}, {"box", box_json(part.box)}});
    return {{"kind", "mesh"},
            {"format", file.format},
            {"name", file.name},
            {"triangles", file.stored_triangles},
            {"unit", unit_name(plate.files.front().unit_mm)},
            {"box", box_json(plate.box)},
            {"parts", std::move(bodies)}};
}

Json described(const LayerFile& file) {
    Json parts = Json::array();
    for (const PartInfo& part : file.parts)
        parts.push_back(
            {{"label", part.label}, {"support", part.support}, {"vectors", part.exposure.has_value()}});
    return {{"kind", "layers"},
            {"format", file.format},
            {"layers", file.planes.size()},
            {"parts", std::move(parts)}};
}

int run_read(const ReadArguments& arguments, const Context& context) {
    const Execution execution = arguments.run.execution(context);
    auto read = read_any(arguments.input, arguments.limits.of_meshes(), execution);
    Json facts;
    if (auto* const mesh = std::get_if<MeshFile>(&read)) {
        context.messages.warn_of(input_name(mesh->path), mesh->warnings);
        facts = described(*mesh, load_plate({.path = mesh->path, .unit_mm = arguments.placement.unit_mm()},
                                            *mesh, execution));
    } else {
        const auto& layers = std::get<LayerFile>(read);
        context.messages.warn_of(input_name(layers.path), layers.warnings);
        facts = described(layers);
    }
    context.messages.result(json_text(facts));
    return 0;
}

/// A command that describes a file without a diagnosis. It is not in the help, because people have `info`.
Command read_command() {
    const auto arguments = std::make_shared<ReadArguments>();
    return {.name = "read",
            .summary = "describe a file as JSON, without a diagnosis",
            .description = "Reads a mesh or a slice file.",
            .operands = {{.placeholder = "FILE",
                          .help = "a mesh or a slice file",
                          .set =
                              [arguments](const std::string& text) {
                                  arguments->input = text;
                              }}},
            .groups = {{"input", "Input", {unit_option(arguments->placement.unit)}},
                       run_options(arguments->run, {include_option(arguments->limits),
                                                    max_triangles_option(arguments->limits)}),
                       common_options(false)},
            .run = [arguments](const Context& context) {
                return run_read(*arguments, context);
            }};
}

} // namespace

} // namespace lamella::app

namespace {

int run(const std::vector<std::string>& words) {
    std::vector<lamella::app::Command> commands = lamella::app::all_commands();
    commands.push_back(lamella::app::read_command());
    return lamella::app::run_program(std::move(commands), words);
}

/// `text` has `count` words, each of which ends with a zero.
std::vector<std::string> words_of(const char* text, int count) {
    std::vector<std::string> words;
    for (int i = 0; i < count; ++i)
        text += words.emplace_back(text).size() + 1;
    return words;
}

} // namespace

// Each may be called any number of times in one instance, one after the other.

/// Runs the program on the calling thread alone and returns its exit code.
extern "C" EMSCRIPTEN_KEEPALIVE int lamella_run(const char* text, int count) {
    return run(words_of(text, count));
}

/// Starts the program on threads of its own, `Module.processors` unless --threads gives their number. At the
/// end, `Module.ended` is called on the calling thread, which has to return to its event loop, because it
/// starts threads and serves the file system.
extern "C" EMSCRIPTEN_KEEPALIVE void lamella_start(const char* text, int count) {
    std::thread([words = words_of(text, count)] { lamella_ended(run(words), 0); }).detach();
}
