#include "system/spill_file.hpp"

#include "lamella/core/error.hpp"

#include "core/byte_amount.hpp"
#include "system/nameless_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace lamella {

SpillFile::SpillFile(std::uint64_t bytes, std::uint64_t of_all)
    : folder_(scratch_folder()), bytes_(std::max(bytes, of_all)) {
    descriptor_ = create_scratch(folder_);
    if (descriptor_ < 0)
        fail(errno);
    if (bytes == 0)
        return;
    int failed = 0;
    do
        failed = fallocate(descriptor_, 0, 0, static_cast<off_t>(bytes)) == 0 ? 0 : errno;
    while (failed == EINTR);
    if (failed == ENOSPC || failed == EDQUOT || failed == EFBIG) {
        close(descriptor_);
        fail(failed);
    }
}

SpillFile::~SpillFile() {
    close(descriptor_);
}

void SpillFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written >= 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(written));
            offset += static_cast<std::uint64_t>(written);
        } else if (errno != EINTR) {
            fail(errno);
        }
    }
}

void SpillFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
        const ssize_t got = pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (got == 0)
            fail(EIO); // the file was longer when it was written
        if (got > 0) {
            bytes = bytes.subspan(static_cast<std::size_t>(got));
            offset += static_cast<std::uint64_t>(got);
        } else if (errno != EINTR) {
            fail(errno);
        }
    }
}

void SpillFile::forget(std::uint64_t offset, std::uint64_t bytes) noexcept {
    const int before = errno;
    fallocate(descriptor_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset),
              static_cast<off_t>(bytes));
    errno = before; // a failure here has no consequence
}

void SpillFile::fail(int system_error) const {
    const std::string what = bytes_ != 0 ? byte_amount(bytes_) + " of temporary data" : "temporary data";
    std::string text = fmt::format("{}: cannot hold {}: ", folder_, what);
    struct statvfs status {};
    if (system_error == ENOSPC && statvfs(folder_.c_str(), &status) == 0)
        text += fmt::format("the disk is full ({} free)",
                            byte_amount(std::uint64_t{status.f_bavail} * status.f_frsize));
    else if (system_error == EDQUOT)
        text += "the disk quota is used up";
    else if (system_error == EFBIG)
        text += "files may not grow so large there (see ulimit -f)";
    else
        text += std::generic_category().message(system_error);
    throw Error(ErrorKind::output,
                text + "; set the environment variable TMPDIR to a folder with more room, or raise "
                       "`max_memory`");
}

} // namespace lamella
