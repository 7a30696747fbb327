#include "batch.hpp"

#include "lamella/core/error.hpp"

#include "batch_files.hpp"
#include "failure.hpp"
#include "figures.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "resin_figures.hpp"
#include "text_file.hpp"
#include "worker_team.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

namespace lamella::app {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Bytes of a mesh file per thread: for smaller files, a second thread costs more than it gains.
constexpr std::uint64_t bytes_per_thread = 16'000'000;
constexpr std::size_t most_warnings = 8;
// Several small files form one task, because a message costs as much as slicing one of them. Their number and
// time are limited, so that results are not delayed noticeably.
constexpr std::uint64_t small_file = 100'000; // bytes
constexpr std::size_t most_together = 32;
constexpr double longest_together = 0.05; // seconds
// Time that a stopped batch waits for answers. It is well below that after which Interrupt ends the program,
// so that the answers can be printed.
constexpr double longest_stop = 0.3; // seconds

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

Json name_or_null(const std::string& name) {
    return name.empty() ? Json() : Json(name);
}

/// Returns the JSON object of one result.
Json record_of(const BatchItem& item, const BatchResult& result) {
    const FileResult& file = result.file;
    Json warnings = Json::array();
    for (const std::string& warning : result.warnings)
        if (warnings.size() < most_warnings)
            warnings.push_back(warning);
    const Figures run = run_figures(file);
    Json record = {{"path", item.input}, {"output", name_or_null(item.output)}, {"ok", true}};
    record.update(as_json(picked(run, {"triangles", "layers", "contours", "open_chains", "points",
                                       "volume_mm3", "hash", "bytes", "threads"})));
    if (file.resin)
        record.update(as_json(amount_figures(*file.resin)));
    record["seconds"] = as_json(run)["total"];
    record["warnings"] = std::move(warnings);
    return record;
}

Json record_of(const BatchItem& item, const Failure& failure, double seconds, bool written = false) {
    return {{"path", item.input},
            {"output", written ? name_or_null(item.output) : Json()},
            {"ok", false},
            {"error", {{"kind", failure.kind}, {"text", failure.text}, {"exit_code", failure.exit_code}}},
            {"seconds", seconds}};
}

Json sliced(const BatchItem& item, const SliceItem& slice, const Execution& execution) {
    const Clock::time_point start = Clock::now();
    bool written = false;
    try {
        const BatchResult result = slice(item, execution);
        written = true;
        if (!item.stats.empty())
            after_output(item.output, [&] { write_text_file(item.stats, result.stats); });
        return record_of(item, result);
    } catch (...) {
        Failure failure = failure_of(std::current_exception());
        // A link in a folder of others can lead to any file, whose text is no business of those who put it
        // there.
        std::error_code ignored;
        if (failure.kind == "input" && fs::is_symlink(item.input, ignored))
            failure.text =
                fmt::format("{}: is a link, and what it leads to cannot be sliced; the reason is shown "
                            "if the file is sliced alone",
                            item.input);
        // Errors of a job with a single file may omit its name.
        if (failure.text.find(item.input) == std::string::npos)
            failure.text = fmt::format("{}: {}", item.input, failure.text);
        return record_of(item, failure, seconds_since(start), written);
    }
}

std::string as_line(const Json& record) {
    return compact_json(record) + '\n';
}

/// Returns the line of a result, with names and texts truncated if necessary so that it fits into a message.
/// (An escape takes up to six bytes per byte.)
std::string short_line(Json record) {
    constexpr std::size_t most_text = 1000;
    std::string line = as_line(record);
    if (line.size() <= WorkerTeam::longest_answer)
        return line;
    if (record.contains("warnings"))
        record["warnings"] = {"the warnings are too long to be listed here"};
    if (record.contains("error"))
        record["error"]["text"] = record["error"]["text"].get<std::string>().substr(0, most_text) + "...";
    return as_line(record);
}

/// Returns the lines for the files of a task, or only for the first ones if the others would delay the
/// answer.
std::string lines_of(const WorkerTask& task, const std::vector<BatchItem>& items, const SliceItem& slice,
                     const CancelFlag& cancel) {
    const Clock::time_point start = Clock::now();
    std::string lines;
    for (std::size_t i = task.first; i < task.first + task.count; ++i) {
        if (!lines.empty() && (cancel.requested() || seconds_since(start) > longest_together))
            break;
        const std::string line =
            short_line(sliced(items[i], slice, {.threads = task.threads, .cancel = &cancel}));
        if (!lines.empty() && lines.size() + line.size() > WorkerTeam::longest_answer)
            break; // this file is done again later
        lines += line;
    }
    assert(lines.size() <= WorkerTeam::longest_answer);
    return lines;
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

/// Returns all items as a text for workers, which must not look for the files again, and back.
std::string introduction_of(const std::vector<BatchItem>& items) {
    Json rows = Json::array();
    for (const BatchItem& item : items)
        rows.push_back({item.input, item.output, item.stats});
    return rows.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<BatchItem> introduced_items(const std::string& text) {
    std::vector<BatchItem> items;
    for (const Json& row : Json::parse(text))
        items.push_back({row[0], row[1], row[2]});
    return items;
}

/// Slices the files in order, several at the same time as far as there are threads.
class Batch {
  public:
    Batch(const std::vector<BatchItem>& items, unsigned threads, const SliceItem& slice,
          const Execution& execution, Messages& messages)
        : items_(items), most_(execution.threads == 0 ? threads : std::min(threads, execution.threads)),
          threads_(threads), free_(threads), messages_(messages), progress_(execution.progress),
          starts_(items.size()), team_(
                                     std::min<std::size_t>(threads, items.size()),
                                     [&items, &slice](const WorkerTask& task, const CancelFlag& cancel) {
                                         return lines_of(task, items, slice, cancel);
                                     },
                                     introduction_of(items)) {}

    bool run(const Execution& execution) {
        while (reported_ < items_.size() && !execution.cancelled()) {
            start_some(execution);
            for (const WorkerAnswer& answer : team_.wait())
                take(answer);
            report();
        }
        if (reported_ == items_.size())
            return true;
        // Completed results are still printed. The destructor of the team ends stuck workers.
        stopping_ = true;
        team_.stop();
        const Clock::time_point stop = Clock::now();
        while (team_.is_busy() && seconds_since(stop) < longest_stop)
            for (const WorkerAnswer& answer : team_.wait())
                take(answer);
        report();
        return reported_ == items_.size();
    }

    [[nodiscard]] std::size_t failed() const { return reported_ - succeeded_; }

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
            text += fmt::format(", {} failed ({})", grouped(reported_ - succeeded_), fmt::join(kinds, ", "));
        if (reported_ < items_.size())
            text += fmt::format(", {} not begun or cancelled", grouped(items_.size() - reported_));
        text += fmt::format("\ntook     {:.3f} s, {} files a second\n", seconds,
                            brief(std::round(static_cast<double>(reported_) / seconds)));
        const Json json = {{"batch",
                            {{"files", items_.size()},
                             {"ok", succeeded_},
                             {"failed", std::move(failed)},
                             {"not_done", items_.size() - reported_},
                             {"seconds", seconds}}}};
        messages_.sum_up(text, compact_json(json));
    }

  private:
    /// Starts tasks. A task waits until its number of threads is free, so large files cannot starve.
    void start_some(const Execution& execution) {
        while (!execution.cancelled()) {
            if (tasks_.empty() && next_ < items_.size())
                tasks_.push_back(take_next());
            if (tasks_.empty() || tasks_.front().threads > free_)
                return;
            const WorkerTask task = tasks_.front();
            starts_[task.first] = Clock::now();
            try {
                team_.start(task);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::limit || !team_.is_busy())
                    throw;
                return; // a busy worker takes it later
            }
            tasks_.pop_front();
            free_ -= task.threads;
        }
    }

    /// Returns a task of one file, or of several small ones. If few files remain, tasks are smaller, so that
    /// all workers stay busy.
    WorkerTask take_next() {
        const auto bytes_of = [this](std::size_t i) {
            std::error_code error; // set for a pipe, for example, whose size is unknown
            const std::uintmax_t bytes = fs::file_size(items_[i].input, error);
            return error ? std::nullopt : std::optional(bytes);
        };
        const auto is_small = [](std::optional<std::uintmax_t> bytes) {
            return bytes && *bytes < small_file;
        };
        const std::optional<std::uintmax_t> bytes = bytes_of(next_);
        const std::uintmax_t threads = bytes.value_or(0) / bytes_per_thread;
        WorkerTask task{next_, 1, static_cast<unsigned>(std::clamp<std::uintmax_t>(threads, 1, most_))};
        const std::size_t share = (items_.size() - next_) / (std::size_t{4} * threads_);
        if (is_small(bytes))
            while (task.count < std::min(share, most_together) && is_small(bytes_of(next_ + task.count)))
                ++task.count;
        next_ += task.count;
        return task;
    }

    void take(const WorkerAnswer& answer) {
        const WorkerTask& task = answer.task;
        free_ += task.threads;
        if (!answer.begun) {
            tasks_.push_front(task);
            return;
        }
        const auto start_alone = [&](std::size_t first) {
            for (std::size_t i = task.first + task.count; i-- > first;)
                tasks_.push_front({i, 1, task.threads});
        };
        if (answer.text) {
            std::size_t done = task.first;
            for (std::string_view rest = *answer.text; !rest.empty(); ++done) {
                const std::size_t line =
                    std::min(rest.find('\n'), rest.size() - 1) + 1; // the last one may be incomplete
                waiting_.emplace(done, rest.substr(0, line));
                rest.remove_prefix(line);
            }
            start_alone(done); // the remaining files take long
        } else if (task.count > 1) {
            start_alone(task.first); // any of them may have ended the process
        } else if (!stopping_) {
            const BatchItem& item = items_[task.first];
            waiting_.emplace(task.first,
                             short_line(record_of(item, failure_of_process(answer.end, item.input),
                                                  seconds_since(starts_[task.first]))));
        }
    }

    /// Prints results in order, each once all before it are printed; after a stop, all results that exist.
    void report() {
        for (; !waiting_.empty() && (stopping_ || waiting_.begin()->first == due_); ++due_) {
            const std::string line = std::move(waiting_.extract(waiting_.begin()).mapped());
            const Json record = Json::parse(line);
            if (stopping_ && !record["ok"] && record["error"]["kind"] == "cancelled")
                continue;
            ++reported_;
            if (record["ok"]) {
                ++succeeded_;
            } else {
                const Json& error = record["error"];
                ++failures_[error["kind"]];
                messages_.error(error["text"], error["exit_code"]);
            }
            messages_.result(line);
        }
        finish_printing();
        if (progress_)
            progress_({Stage::slice, reported_, items_.size()});
    }

    const std::vector<BatchItem>& items_;
    unsigned most_; ///< upper bound on threads for one file
    unsigned threads_;
    unsigned free_;
    Messages& messages_;
    const std::function<void(const Progress&)>& progress_;
    std::vector<Clock::time_point> starts_; ///< start times, by the first file of each task
    std::deque<WorkerTask> tasks_;          ///< waiting for threads
    std::map<std::size_t, std::string> waiting_;
    std::map<std::string, std::size_t> failures_; ///< by kind
    std::size_t next_ = 0;                        ///< first file without a task
    std::size_t due_ = 0;                         ///< file whose result is printed next
    std::size_t reported_ = 0;                    ///< number of printed results
    std::size_t succeeded_ = 0;
    bool stopping_ = false;
    WorkerTeam team_; ///< last: its destructor does not use the other members
};

} // namespace

OptionGroup batch_options(BatchArguments& target) {
    Option batch =
        input_file("batch",
                   "slice many files, each by itself: all meshes in a folder, or those listed in a file, one "
                   "path per line; prints a JSON object for each",
                   target.source);
    batch.placeholder = "FOLDER|LIST";
    batch.configurable = false;
    Option jobs =
        count("jobs", "N",
              "number of processors for the batch; 0, the default, uses all: small files are sliced "
              "side by side, large ones on several threads",
              target.jobs);
    jobs.goes_with = "batch";
    return {"batch", "Batch", {std::move(batch), std::move(jobs)}};
}

std::vector<BatchItem> batch_items(const BatchArguments& arguments, const std::string& output,
                                   std::string_view extension, const std::string& stats,
                                   std::span<const NamedFile> read) {
    if (const std::optional<std::string> introduction = introduction_to_worker())
        return introduced_items(*introduction);
    const std::string results = has_placeholder(output) ? std::string() : output;
    const std::vector<std::string> inputs = batch_inputs(arguments.source, results);
    std::vector<std::string> kept = inputs;
    for (const NamedFile& file : read)
        if (file.path != "-")
            kept.push_back(file.path);
    OutputNames names;
    std::vector<BatchItem> items(inputs.size());
    for (std::size_t i = 0; i < inputs.size(); ++i)
        items[i].input = inputs[i];
    std::vector<std::string> given;
    const auto give = [&](const std::string& pattern, std::string_view ending, std::string BatchItem::*into) {
        if (pattern.empty())
            return;
        for (std::size_t i = 0; std::string & name : names.give(inputs, pattern, ending)) {
            items[i++].*into = name;
            given.push_back(std::move(name));
        }
    };
    give(output, extension, &BatchItem::output);
    give(stats, ".json", &BatchItem::stats);
    check_distinct(kept, given);
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
