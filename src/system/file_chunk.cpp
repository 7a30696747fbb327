#include "system/file_chunk.hpp"

#include "system/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstddef>
#include <utility>

namespace lamella {

FileChunk::FileChunk(const std::string& path, std::uint64_t offset, std::string name)
    : name_(std::move(name)), offset_(offset), descriptor_(::open(path.c_str(), O_WRONLY | O_CLOEXEC)) {
    if (descriptor_ < 0)
        throw output_error(name_, errno);
}

FileChunk::~FileChunk() {
    if (descriptor_ >= 0)
        ::close(descriptor_);
}

void FileChunk::append(std::string_view bytes) {
    assert(descriptor_ >= 0);
    while (!bytes.empty()) {
        const ssize_t written =
            ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset_));
        if (written < 0) {
            if (errno != EINTR)
                throw output_error(name_, errno);
            continue;
        }
        assert(static_cast<std::size_t>(written) <= bytes.size());
        bytes.remove_prefix(static_cast<std::size_t>(written));
        offset_ += static_cast<std::uint64_t>(written);
    }
}

void FileChunk::finish() {
    assert(descriptor_ >= 0);
    // On network file systems, errors for the last bytes are reported only now.
    if (::fsync(descriptor_) != 0 && errno != EINVAL)
        throw output_error(name_, errno);
    if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR)
        throw output_error(name_, errno);
}

} // namespace lamella
