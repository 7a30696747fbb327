#include "pipeline/job_output.hpp"

#include "lamella/core/error.hpp"

#include "pipeline/agreement.hpp"
#include "pipeline/packed.hpp"
#include "system/file_chunk.hpp"
#include "write/layer_writers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <sstream>
#include <system_error>
#include <utility>

namespace lamella {
namespace {

/// Returns whether several processes can write a file: it does not exist, or is a regular one.
bool can_be_shared(const std::string& path) {
    std::error_code ignored;
    const auto status = std::filesystem::status(path, ignored);
    return path != "-" && (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status));
}

std::string packed(std::span<const Layer> parts, std::span<const PointArray> hatches) {
    Packer packer;
    packer.put(std::uint64_t{parts.size()});
    for (const Layer& layer : parts)
        packer.put(layer.index)
            .put(layer.z)
            .put(layer.bottom)
            .put(layer.top)
            .put(std::uint64_t{layer.rings})
            .put_all(std::span(layer.offsets))
            .put_all(layer.points.span());
    for (const PointArray& lines : hatches)
        packer.put_all(lines.span());
    return packer.take();
}

/// Returns layers without hatch lines as vectors without them.
ScanVectors unpacked(const std::string& message) {
    Unpacker unpacker(message);
    ScanVectors vectors;
    vectors.polylines.resize(unpacker.get<std::uint64_t>());
    vectors.hatches.resize(vectors.polylines.size());
    for (Layer& layer : vectors.polylines) {
        layer.index = unpacker.get<std::uint64_t>();
        layer.z = unpacker.get<double>();
        layer.bottom = unpacker.get<double>();
        layer.top = unpacker.get<double>();
        layer.rings = unpacker.get<std::uint64_t>();
        layer.offsets = unpacker.get_all<std::uint64_t>();
        layer.points = PointArray(unpacker.get_all<Point2>());
    }
    for (std::size_t i = 0; i < vectors.exposures() && !unpacker.empty(); ++i)
        vectors.hatches[i] = PointArray(unpacker.get_all<Point2>());
    return vectors;
}

/// Writes the bytes at offset `position` of an existing file; errors call it `name`.
void write_at(const std::string& path, std::uint64_t position, const ByteStore& bytes,
              const std::string& name) {
    FileChunk chunk(path, position, name);
    std::string block;
    for (std::uint64_t at = 0; at < bytes.size(); at += block.size()) {
        block.resize(std::min<std::uint64_t>(ByteStore::block_bytes, bytes.size() - at));
        bytes.read(at, block);
        chunk.append(block);
    }
    chunk.finish();
}

} // namespace

Rounding OutputFiles::rounding() const noexcept {
    Rounding rounding = format == nullptr ? Rounding{} : format->rounding.value_or(Rounding{});
    if ((rounding.step_mm > 0 && format->units) ||
        (format != nullptr && format->short_form && write.short_form))
        rounding = {.step_mm = write.units_mm};
    return rounding;
}

JobOutput::JobOutput(const OutputFiles& files, LayerFileInfo info, PlaneRange mine, Communicator& processes,
                     std::uint64_t most_in_memory)
    : processes_(processes), path_(files.path), most_bytes_(files.write.most_bytes),
      strict_(files.write.strict), format_(files.format), waiting_(most_in_memory) {
    if (format_ != nullptr) {
        LayerWriteOptions options = files.write;
        shared_ = processes.size() > 1 && format_->chunks && can_be_shared(path_);
        if (shared_) {
            in_agreement(processes, [&] {
                if (processes.process() == 0)
                    file_.emplace(path_);
            });
            working_path_ = processes.gather(file_ ? file_->share() : std::string()).front();
            chunk_ = {mine.begin, mine.size(),
                      [this](std::string_view bytes, const std::shared_ptr<const void>&, Completions&) {
                          waiting_.add(bytes);
                      }};
            info.chunk = &chunk_;
            // These two options apply to the whole file.
            options.most_bytes = 0;
            options.strict = false;
        }
        in_agreement(processes, [&] {
            if (shared_ || processes.process() == 0)
                writer_ = open_layer_writer(path_, *format_, info, options);
        });
        info.chunk = nullptr;
    }
    if (!files.page_path.empty())
        page_ = open_layer_page(files.page_path, info, files.page);
}

template <class Plane, class Message>
Commit JobOutput::prepared(const Plane& plane, const Message& message) {
    Commit to_file;
    if (writer_)
        to_file = writer_->prepare(plane);
    else if (format_ != nullptr)
        to_file = [this, bytes = message()] {
            waiting_.add(bytes);
            messages_.push_back(bytes.size());
        };
    if (!page_)
        return to_file;
    return [to_file = std::move(to_file), to_page = page_->prepare(plane)](Completions& after) {
        if (to_file)
            to_file.in_order(after);
        to_page.in_order(after);
    };
}

Commit JobOutput::prepare(std::span<const Layer> parts) {
    return prepared(parts, [&] { return packed(parts, {}); });
}

Commit JobOutput::prepare(const ScanVectors& vectors) {
    return prepared(vectors, [&] { return packed(vectors.polylines, vectors.hatches); });
}

void JobOutput::finish_file(FileResult& result) {
    if (format_ == nullptr)
        return;
    result.format = format_->name;
    in_agreement(processes_, [&] {
        if (!writer_)
            return send_layers();
        if (!shared_)
            write_layers_of_others();
        if (!shared_ || chunk_.layers > 0)
            writer_->finish();
        result.bytes = shared_ ? 0 : writer_->bytes();
    });
    if (shared_)
        gather_losses();
    result.warnings = warnings_of_file();
    if (shared_)
        result.bytes = write_shared();
    else
        processes_.sum(std::span(&result.bytes, 1)); // the other processes have 0
}

/// Adds the losses of all ranges to those of the first range, which process 0 has written.
void JobOutput::gather_losses() {
    const std::vector<std::string> all = processes_.gather(Packer().put(writer_->losses()).take());
    in_agreement(processes_, [&] {
        if (processes_.process() != 0)
            return;
        for (std::size_t p = 1; p < all.size(); ++p)
            writer_->add_losses(Unpacker(all[p]).get<WriteLosses>());
        if (strict_)
            check_warnings(path_, writer_->warnings());
    });
}

/// Returns the warnings of process 0, on all processes.
std::vector<std::string> JobOutput::warnings_of_file() {
    const std::vector<std::string> mine =
        processes_.process() == 0 ? writer_->warnings() : std::vector<std::string>();
    std::istringstream lines(processes_.gather(fmt::format("{}", fmt::join(mine, "\n"))).front());
    std::vector<std::string> warnings;
    for (std::string warning; std::getline(lines, warning);)
        warnings.push_back(warning);
    return warnings;
}

std::vector<std::string> JobOutput::finish_page(const PageNotes& notes) {
    page_->add_notes(notes);
    page_->finish();
    return page_->warnings();
}

void JobOutput::send_layers() {
    std::uint64_t at = 0;
    std::string message;
    for (const std::uint64_t length : messages_) {
        message.resize(length);
        waiting_.read(at, message);
        processes_.send(0, message);
        at += length;
    }
    processes_.send(0, {});
}

/// Writes the layers in order. If the writer fails, the remaining messages are received nevertheless.
void JobOutput::write_layers_of_others() {
    std::exception_ptr error;
    for (std::size_t from = 1; from < processes_.size(); ++from)
        for (std::string message; !(message = processes_.receive(from)).empty();) {
            if (error)
                continue;
            try {
                writer_->prepare(unpacked(message))();
            } catch (...) {
                error = std::current_exception();
            }
        }
    if (error)
        std::rethrow_exception(error);
}

/// Writes the range of each process at its offset, which is the sum of the sizes of the ranges before it.
std::uint64_t JobOutput::write_shared() {
    std::vector<std::uint64_t> sizes(processes_.size(), 0);
    sizes[processes_.process()] = waiting_.size();
    processes_.sum(sizes);
    std::uint64_t total = 0;
    std::uint64_t position = 0;
    for (std::size_t p = 0; p < sizes.size(); ++p) {
        if (p == processes_.process())
            position = total;
        total += sizes[p];
    }
    check_bytes(path_, total, most_bytes_);
    in_agreement(processes_, [&] { write_at(working_path_, position, waiting_, path_); });
    in_agreement(processes_, [&] {
        if (file_)
            file_->commit();
    });
    return total;
}

} // namespace lamella
