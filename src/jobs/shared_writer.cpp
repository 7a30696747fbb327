#include "jobs/shared_writer.hpp"

#include "container/checked_output.hpp"
#include "jobs/packed.hpp"
#include "system/file_chunk.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
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

std::string packed(const Plane& plane) {
    Packer packer;
    packer.put(std::uint64_t{plane.parts()});
    for (const Layer& layer : plane.polylines)
        packer.put(layer.index)
            .put(layer.z)
            .put(layer.bottom)
            .put(layer.top)
            .put(std::uint64_t{layer.rings})
            .put_all(std::span(layer.offsets))
            .put_all(layer.points.span());
    for (const PointArray& lines : plane.hatches)
        packer.put_all(lines.span());
    return packer.take();
}

Plane unpacked(Unpacker& unpacker) {
    Plane plane(std::vector<Layer>(unpacker.get<std::uint64_t>()));
    for (Layer& layer : plane.polylines) {
        layer.index = unpacker.get<std::uint64_t>();
        layer.z = unpacker.get<double>();
        layer.bottom = unpacker.get<double>();
        layer.top = unpacker.get<double>();
        layer.rings = unpacker.get<std::uint64_t>();
        layer.offsets = unpacker.get_all<std::uint64_t>();
        layer.points = PointArray(unpacker.get_all<Point2>());
    }
    for (PointArray& lines : plane.hatches)
        lines = PointArray(unpacker.get_all<Point2>());
    return plane;
}

void put(Packer& to, const std::string& text) {
    to.put_all(std::span<const char>(text));
}

std::string get_text(Unpacker& from) {
    const std::vector<char> text = from.get_all<char>();
    return {text.begin(), text.end()};
}

/// Puts findings of one file, without labels of parts.
void put(Packer& to, const Findings& findings) {
    to.put(std::uint64_t{findings.by_file.size()});
    for (const Finding& one : findings.by_file) {
        to.put(one.kind).put(one.count).put(one.amount).put(one.largest);
        to.put(one.layers).put(one.of_layers).put(one.first_z).put(one.first_layer);
        put(to, one.place);
        to.put(std::uint64_t{one.entries.size()});
        for (const std::string& entry : one.entries)
            put(to, entry);
    }
}

Findings get_findings(Unpacker& from) {
    Findings findings;
    for (auto n = from.get<std::uint64_t>(); n > 0; --n) {
        Finding one{.kind = from.get<FindingKind>()};
        one.count = from.get<std::uint64_t>();
        one.amount = from.get<double>();
        one.largest = from.get<double>();
        one.layers = from.get<std::uint64_t>();
        one.of_layers = from.get<std::uint64_t>();
        one.first_z = from.get<double>();
        one.first_layer = from.get<std::uint64_t>();
        one.place = get_text(from);
        for (auto entries = from.get<std::uint64_t>(); entries > 0; --entries)
            one.entries.push_back(get_text(from));
        findings.add(std::move(one));
    }
    return findings;
}

WriteLosses get_losses(Unpacker& from) {
    WriteLosses losses;
    losses.layers = from.get<std::uint64_t>();
    losses.first_z = from.get<double>();
    losses.bottom = from.get<double>();
    losses.top = from.get<double>();
    losses.found = get_findings(from);
    return losses;
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

SharedWriter::SharedWriter(const OutputFiles& files, LayerFileInfo info, PlaneRange mine,
                           Agreement& processes, std::uint64_t most_in_memory)
    : processes_(processes), path_(files.path), most_bytes_(files.write.most_bytes),
      strict_(files.write.strict), in_chunks_(files.format->chunks && can_be_shared(path_)),
      waiting_(most_in_memory) {
    const bool first = processes.process() == 0;
    LayerWriteOptions options = files.write;
    if (in_chunks_) {
        if (first)
            file_.emplace(path_);
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
    if (in_chunks_ || first)
        writer_ = open_layer_writer(path_, *files.format, info, options);
    processes.gather({}); // a file that cannot be written is reported before hours of slicing
}

Commit SharedWriter::prepare(const Plane& plane) {
    return writer_ ? writer_->prepare(plane) : kept(packed(plane));
}

Commit SharedWriter::kept(std::string plane) {
    return [this, bytes = std::move(plane)] {
        if (batches_.empty() || batches_.back() + bytes.size() > ByteStore::block_bytes)
            batches_.push_back(0);
        batches_.back() += bytes.size();
        waiting_.add(bytes);
    };
}

void SharedWriter::finish() {
    if (in_chunks_)
        write_chunks();
    else
        write_layers_of_others();
    // Process 0 knows the losses, and the size of a file that it has written alone.
    Packer mine;
    mine.put(bytes_);
    put(mine, processes_.process() == 0 ? writer_->findings() : Findings());
    const std::vector<std::string> all = processes_.gather(mine.take());
    Unpacker from(all.front());
    bytes_ = from.get<std::uint64_t>();
    losses_ = get_findings(from);
    if (file_)
        file_->commit();
}

/// Sends the layers of the other processes to process 0, which writes them in order.
void SharedWriter::write_layers_of_others() {
    std::vector<std::uint64_t> batches; // of each process
    for (const std::string& message : processes_.gather(Packer().put(std::uint64_t{batches_.size()}).take()))
        batches.push_back(Unpacker(message).get<std::uint64_t>());
    std::uint64_t at = 0;
    for (std::size_t from = 0; from < batches.size(); ++from)
        for (std::uint64_t i = 0; i < batches[from]; ++i) {
            std::string batch;
            if (from == processes_.process()) {
                batch.resize(batches_[i]);
                waiting_.read(at, batch);
                at += batch.size();
            }
            std::vector<std::span<const char>> outgoing(processes_.size());
            outgoing.front() = batch;
            const auto received = processes_.exchange<char>(outgoing);
            for (Unpacker layers({received->data(), received->size()}); !layers.empty();)
                writer_->prepare(unpacked(layers))();
        }
    if (!writer_)
        return;
    writer_->finish();
    bytes_ = writer_->bytes();
}

/// Writes the range of each process at its offset, which is the sum of the sizes of the ranges before it.
void SharedWriter::write_chunks() {
    if (chunk_.layers > 0)
        writer_->finish();
    std::uint64_t position = 0;
    const WriteLosses losses = writer_->losses();
    Packer mine;
    mine.put(waiting_.size()).put(losses.layers).put(losses.first_z).put(losses.bottom).put(losses.top);
    put(mine, losses.found);
    const std::vector<std::string> all = processes_.gather(mine.take());
    for (std::size_t p = 0; p < all.size(); ++p) {
        Unpacker from(all[p]);
        if (p == processes_.process())
            position = bytes_;
        bytes_ += from.get<std::uint64_t>();
        if (processes_.process() == 0 && p > 0) // whose range is the first one
            writer_->add_losses(get_losses(from));
    }
    if (strict_ && processes_.process() == 0)
        check_strictly(path_, writer_->findings());
    check_bytes(path_, bytes_, most_bytes_);
    write_at(working_path_, position, waiting_, path_);
}

} // namespace lamella
