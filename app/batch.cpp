#include "batch.hpp"

#include "lamella/contour/stack_hash.hpp"
#include "lamella/core/error.hpp"

#include "batch_files.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "text_file.hpp"
#include "worker_team.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

namespace lamella::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Of a mesh file: below, a second thread costs more than it brings.
constexpr std::uint64_t bytes_per_thread = 16'000'000;
constexpr std::size_t most_warnings = 8;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Json name_or_null(const std::string& name) {
    return name.empty() ? Json() : Json(name);
}

/// One line of the results.
Json record_of(const BatchItem& item, const BatchResult& result) {
    const FileResult& file = result.file;
    std::vector<std::uint64_t> hashes;
    for (const LayerStatistics& layer : file.layers)
        hashes.push_back(layer.hash);
    Json warnings = Json::array();
    for (const std::string& warning : result.warnings)
        if (warnings.size() < most_warnings)
            warnings.push_back(warning);
    const Figures run = run_figures(file);
    Json record = {{"path", item.input}, {"output", name_or_null(item.output)}, {"ok", true}};
    record.update(
        as_json(picked(run, {"triangles", "layers", "contours", "open_chains", "points", "volume_mm3"})));
    record["hash"] = fmt::format("{:016x}", stack_hash(hashes));
    record.update(as_json(picked(run, {"bytes", "threads"})));
    record["seconds"] = as_json(run)["total"];
    record["warnings"] = std::move(warnings);
    return record;
}

Json record_of(const BatchItem& item, const Failure& failure, double seconds) {
    return {{"path", item.input},
            {"output", Json()},
            {"ok", false},
            {"error", {{"kind", failure.kind}, {"text", failure.text}, {"exit_code", failure.exit_code}}},
            {"seconds", seconds}};
}

Json sliced(const BatchItem& item, const SliceItem& slice, const Execution& execution) {
    const Clock::time_point start = Clock::now();
    try {
        return record_of(item, slice(item, execution));
    } catch (...) {
        Failure failure = failure_of(std::current_exception());
        // Where there is one file only, its name need not be said.
        if (failure.text.find(item.input) == std::string::npos)
            failure.text = fmt::format("{}: {}", item.input, failure.text);
        return record_of(item, failure, seconds_since(start));
    }
}

/// As a worker sends it.
std::string as_text(const Json& record) {
    return record.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// How many threads a file is worth, of those that there are.
unsigned threads_for(const std::string& path, unsigned all) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(path, error);
    return error ? 1U : static_cast<unsigned>(std::clamp<std::uintmax_t>(bytes / bytes_per_thread, 1, all));
}

void make_folders(const std::vector<BatchItem>& items) {
    std::set<fs::path> folders;
    for (const BatchItem& item : items)
        for (const std::string& name : {item.output, item.stats})
            if (!name.empty())
                folders.insert(fs::path(name).parent_path());
    for (const fs::path& folder : folders) {
        std::error_code error;
        if (!folder.empty() && !fs::create_directories(folder, error) && error)
            throw Error(ErrorKind::output,
                        fmt::format("the folder '{}' cannot be made: {}", folder.string(), error.message()));
    }
}

/// Files in their order, as many at once as there are threads for.
class Batch {
  public:
    Batch(const std::vector<BatchItem>& items, unsigned threads, const SliceItem& slice,
          const Execution& execution, Messages& messages)
        : items_(items), most_(execution.threads == 0 ? threads : std::min(threads, execution.threads)),
          free_(threads), messages_(messages), progress_(execution.progress), starts_(items.size()),
          worth_(items.size()),
          team_(std::min<std::size_t>(threads, items.size()), [&items, &slice](const WorkerTask& task,
                                                                               const CancelFlag& cancel) {
              return as_text(sliced(items[task.index], slice, {.threads = task.threads, .cancel = &cancel}));
          }) {}

    /// Returns whether it came to the end.
    bool run(const Execution& execution) {
        while (told_ < items_.size() && !execution.cancelled()) {
            start_some();
            for (WorkerAnswer& answer : team_.wait())
                take(answer);
            tell();
        }
        return told_ == items_.size();
    }

    [[nodiscard]] std::size_t failed() const { return told_ - succeeded_; }

    void sum_up(double seconds) {
        std::string text =
            fmt::format("batch    {}: {} sliced", counted(items_.size(), "file"), grouped(succeeded_));
        Json failed = Json::object();
        std::vector<std::string> kinds;
        for (const auto& [kind, count] : failures_) {
            kinds.push_back(fmt::format("{} {}", grouped(count), kind));
            failed[kind] = count;
        }
        if (!kinds.empty())
            text += fmt::format(", {} failed ({})", grouped(told_ - succeeded_), fmt::join(kinds, ", "));
        if (told_ < items_.size())
            text += fmt::format(", {} not begun or cancelled", grouped(items_.size() - told_));
        text += fmt::format("\ntook     {:.3f} s, {} files a second\n", seconds,
                            brief(std::round(static_cast<double>(told_) / seconds)));
        const Json json = {{"batch",
                            {{"files", items_.size()},
                             {"ok", succeeded_},
                             {"failed", std::move(failed)},
                             {"not_done", items_.size() - told_},
                             {"seconds", seconds}}}};
        messages_.sum_up(text, json.dump());
    }

  private:
    /// The next file waits until the threads that it is worth are free; so large files cannot starve.
    void start_some() {
        while (next_ < items_.size()) {
            if (worth_[next_] == 0)
                worth_[next_] = threads_for(items_[next_].input, most_);
            if (worth_[next_] > free_)
                return;
            free_ -= worth_[next_];
            starts_[next_] = Clock::now();
            team_.start({next_, worth_[next_]});
            ++next_;
        }
    }

    void take(WorkerAnswer& answer) {
        const BatchItem& item = items_[answer.index];
        free_ += worth_[answer.index];
        if (!answer.text)
            answer.text = as_text(record_of(item, failure_of_process(answer.status, item.input),
                                            seconds_since(starts_[answer.index])));
        waiting_.emplace(answer.index, std::move(*answer.text));
    }

    /// Prints the results of which all before have been printed.
    void tell() {
        for (; !waiting_.empty() && waiting_.begin()->first == told_; ++told_) {
            const std::string line = std::move(waiting_.extract(waiting_.begin()).mapped());
            const Json record = Json::parse(line);
            if (record["ok"]) {
                ++succeeded_;
            } else {
                const Json& error = record["error"];
                ++failures_[error["kind"]];
                messages_.error(error["text"], error["exit_code"]);
            }
            messages_.result(line + "\n");
        }
        finish_printing();
        if (progress_)
            progress_({Stage::slice, told_, items_.size()});
    }

    const std::vector<BatchItem>& items_;
    unsigned most_; ///< threads for one file
    unsigned free_;
    Messages& messages_;
    const std::function<void(const Progress&)>& progress_;
    std::vector<Clock::time_point> starts_;
    std::vector<unsigned> worth_; ///< threads; 0 where not yet asked for
    std::map<std::size_t, std::string> waiting_;
    std::map<std::string, std::size_t> failures_; ///< by kind
    std::size_t next_ = 0;                        ///< to be started
    std::size_t told_ = 0;
    std::size_t succeeded_ = 0;
    WorkerTeam team_; ///< last: its end needs nothing of the rest
};

} // namespace

OptionGroup batch_options(BatchArguments& target) {
    Option batch =
        input_file("batch",
                   "slice many files, each by itself: all meshes in a folder, or those listed in a file, one "
                   "a line; prints a JSON object for each",
                   target.source);
    batch.placeholder = "FOLDER|LIST";
    batch.configurable = false;
    Option jobs = count("jobs", "N",
                        "processors that the files of a batch share; 0 takes all: as many small files at "
                        "once, large ones on several",
                        target.jobs);
    jobs.goes_with = "batch";
    return {"Many files", {std::move(batch), std::move(jobs)}};
}

std::vector<BatchItem> batch_items(const BatchArguments& arguments, const std::string& output,
                                   std::string_view extension, const std::string& stats) {
    const std::string results = has_placeholder(output) ? std::string() : output;
    const std::vector<std::string> inputs = batch_inputs(arguments.source, results);
    OutputNames names;
    std::vector<BatchItem> items(inputs.size());
    for (std::size_t i = 0; i < inputs.size(); ++i)
        items[i].input = inputs[i];
    const auto give = [&](const std::string& pattern, std::string_view ending, std::string BatchItem::*into) {
        if (pattern.empty())
            return;
        std::vector<std::string> given = names.give(inputs, pattern, ending);
        check_distinct(inputs, given);
        for (std::size_t i = 0; i < items.size(); ++i)
            items[i].*into = std::move(given[i]);
    };
    give(output, extension, &BatchItem::output);
    give(stats, ".json", &BatchItem::stats);
    return items;
}

int run_batch(const std::vector<BatchItem>& items, const BatchArguments& arguments, const SliceItem& slice,
              const Execution& execution, Messages& messages) {
    constexpr std::uint64_t most_jobs = 1024;
    const std::uint64_t jobs = arguments.jobs.value_or(0);
    if (jobs > most_jobs)
        throw Error(ErrorKind::usage,
                    fmt::format("--jobs: {} are too many, {} is the most", jobs, most_jobs));
    const Clock::time_point start = Clock::now();
    make_folders(items);
    const unsigned threads =
        jobs > 0 ? static_cast<unsigned>(jobs) : std::max(1U, std::thread::hardware_concurrency());
    Batch batch(items, threads, slice, execution, messages);
    const bool complete = batch.run(execution);
    batch.sum_up(seconds_since(start));
    if (!complete)
        throw Error(ErrorKind::cancelled, "cancelled");
    return batch.failed() == 0 ? 0 : batch_failed_exit_code;
}

} // namespace lamella::app
