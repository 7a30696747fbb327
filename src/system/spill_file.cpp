#include "system/spill_file.hpp"

#include "lamella/core/error.hpp"

#include "core/byte_amount.hpp"
#include "system/nameless_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>

namespace lamella {

SpillFile::SpillFile(std::uint64_t bytes, std::uint64_t of_all)
    : folder_(scratch_folder()), bytes_(std::max(bytes, of_all)), file_(create_scratch(folder_)) {
    if (!file_.is_open())
        fail(errno);
    // Some file systems take all blocks of the disk before they find that there are too few.
    if (const std::optional<std::uint64_t> free = free_bytes(folder_); free && bytes > *free)
        fail(ENOSPC);
    if (bytes > 0 && !reserve_space(file_, bytes))
        fail(errno);
}

void SpillFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (!write_all_at(file_, offset, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
        fail(errno);
}

void SpillFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    const std::ptrdiff_t got = read_at(file_, offset, bytes);
    if (got < 0)
        fail(errno);
    if (static_cast<std::size_t>(got) < bytes.size())
        fail(EIO); // the file was longer when it was written
}

void SpillFile::forget(std::uint64_t offset, std::uint64_t bytes) noexcept {
    free_space(file_, offset, bytes); // a failure has no consequence
}

void SpillFile::fail(int system_error) const {
    const std::string what = bytes_ != 0 ? byte_amount(bytes_) + " of temporary data" : "temporary data";
    std::string text = fmt::format("{}: cannot hold {}: ", folder_, what);
    const std::optional<std::uint64_t> free = free_bytes(folder_);
    if (system_error == ENOSPC && free)
        text += fmt::format("the disk has {} free", byte_amount(*free));
    else if (system_error == quota_error)
        text += "the disk quota is used up";
    else if (system_error == EFBIG)
        text += "files may not grow so large there (see ulimit -f)";
    else
        text += std::generic_category().message(system_error);
    throw Error(ErrorKind::output,
                text + fmt::format("; set the environment variable {} to a folder with more room, or raise "
                                   "`max_memory`",
                                   scratch_variable()),
                system_error);
}

} // namespace lamella
