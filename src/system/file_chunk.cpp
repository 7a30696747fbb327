#include "system/file_chunk.hpp"

#include "system/atomic_file.hpp"

#include <cassert>
#include <cerrno>
#include <utility>

namespace lamella {

FileChunk::FileChunk(const std::string& path, std::uint64_t offset, std::string name)
    : name_(std::move(name)), offset_(offset), file_(open_existing(path)) {
    if (!file_.is_open())
        throw output_error(name_, errno);
}

void FileChunk::append(std::string_view bytes) {
    assert(file_.is_open());
    if (!write_all_at(file_, offset_, bytes))
        throw output_error(name_, errno);
    offset_ += bytes.size();
}

void FileChunk::finish() {
    assert(file_.is_open());
    // On network file systems, errors for the last bytes are reported only now.
    if (!synchronise(file_) || !file_.close())
        throw output_error(name_, errno);
}

} // namespace lamella
