#include "pipeline/shared_file.hpp"

#include "lamella/core/error.hpp"

#include "pipeline/agreement.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>

namespace lamella {
namespace {

constexpr std::size_t block_bytes = std::size_t{8} << 20;

/// Writes the blocks one after the other, from `place` on, into a file that exists.
void write_at(const std::string& path, std::uint64_t place, const PieceBytes& piece) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0)
        throw output_error(path, errno);
    const auto fail = [&](int system_error) {
        ::close(descriptor);
        throw output_error(path, system_error);
    };
    for (std::string_view block : piece.blocks())
        while (!block.empty()) {
            const ssize_t written =
                ::pwrite(descriptor, block.data(), block.size(), static_cast<off_t>(place));
            if (written < 0 && errno != EINTR)
                fail(errno);
            if (written > 0) {
                block.remove_prefix(static_cast<std::size_t>(written));
                place += static_cast<std::uint64_t>(written);
            }
        }
    // Where files live on another machine, the last bytes meet it only now.
    if (::fsync(descriptor) != 0 && errno != EINVAL)
        fail(errno);
    if (::close(descriptor) != 0 && errno != EINTR)
        throw output_error(path, errno);
}

} // namespace

void PieceBytes::add(std::string_view bytes) {
    if (blocks_.empty() || blocks_.back().size() + bytes.size() > block_bytes)
        blocks_.emplace_back().reserve(std::max(block_bytes, bytes.size()));
    blocks_.back() += bytes;
    size_ += bytes.size();
}

SharedFile::SharedFile(const std::string& path, Communicator& ranks) : path_(path), ranks_(ranks) {
    in_agreement(ranks, [&] {
        if (ranks.rank() == 0)
            file_.emplace(path);
    });
    working_path_ = ranks.gather(file_ ? file_->share() : std::string()).front();
}

std::uint64_t SharedFile::write(const PieceBytes& mine, std::uint64_t most_bytes) {
    std::vector<std::uint64_t> sizes(ranks_.size(), 0);
    sizes[ranks_.rank()] = mine.size();
    ranks_.sum(sizes);
    std::uint64_t total = 0;
    std::uint64_t place = 0;
    for (std::size_t r = 0; r < sizes.size(); ++r) {
        if (r == ranks_.rank())
            place = total;
        total += sizes[r];
    }
    if (most_bytes != 0 && total > most_bytes)
        throw Error(
            ErrorKind::limit,
            fmt::format("'{}' would take {} bytes, more than the {} that it may; choose higher layers, "
                        "another format or a larger limit",
                        path_, total, most_bytes));
    in_agreement(ranks_, [&] { write_at(working_path_, place, mine); });
    in_agreement(ranks_, [&] {
        if (file_)
            file_->commit();
    });
    return total;
}

} // namespace lamella
