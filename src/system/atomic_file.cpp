#include "system/atomic_file.hpp"

#include "lamella/system/whole_file.hpp"

#include "system/nameless_file.hpp"
#include "system/output_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace lamella {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t block_size = std::size_t{1} << 18;
/// Fewer bytes are copied at once, which takes no longer than leaving them for later.
constexpr std::size_t worth_a_completion = std::size_t{1} << 12;

// Returns the first folder in `path` that is missing or is not a folder, which is the one that the user has
// to examine.
std::string first_bad_folder(const std::string& path) {
    fs::path folder = fs::path(path).parent_path();
    std::error_code ignored;
    while (!folder.parent_path().empty() && folder.parent_path() != folder &&
           !fs::is_directory(folder.parent_path(), ignored))
        folder = folder.parent_path();
    return folder.string();
}

/// Returns the network folder of a path on Windows, such as \\server\share, if it cannot be reached; else "".
/// Not every standard library knows such names.
std::string unreachable_share(const std::string& path) {
    constexpr std::string_view separators = "/\\";
    const bool of_network = fs::path::preferred_separator == '\\' && path.size() > 3 &&
                            path.find_first_not_of(separators) == 2 && path[2] != '?' && path[2] != '.';
    const std::size_t end_of_server = of_network ? path.find_first_of(separators, 2) : std::string::npos;
    if (end_of_server == std::string::npos)
        return {};
    const std::string share = path.substr(0, path.find_first_of(separators, end_of_server + 1));
    std::error_code ignored;
    return fs::is_directory(share, ignored) ? std::string() : share;
}

bool working_folder_is_gone() {
    std::error_code error;
    static_cast<void>(fs::current_path(error));
    return error == std::errc::no_such_file_or_directory;
}

std::string folder_of(const std::string& path) {
    const std::string folder = fs::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

} // namespace

void refuse_device(const std::string& path) {
    if (const std::string device = device_named(path); !device.empty())
        throw Error(
            ErrorKind::output,
            fmt::format("cannot write '{}': names that begin with {} stand for a device of this system; "
                        "choose another name",
                        path, device));
}

std::string name_of_output(const std::string& path) {
    return path == "-" ? "standard output" : path;
}

Error output_error(const std::string& path, int system_error) {
    const std::string what = path == "-" ? name_of_output(path) : "'" + path + "'";
    const auto text = [&](const std::string& reason) {
        return Error(ErrorKind::output, fmt::format("cannot write {}: {}", what, reason), system_error);
    };
    // The error for this differs between systems.
    if (path != "-" && fs::path(path).is_relative() && working_folder_is_gone())
        return text("the working folder has been removed; choose another place");
    if (system_error == quota_error)
        return text("the disk quota is used up; free some space or choose another place");
    switch (system_error) {
    case ENOENT:
        if (const std::string folder = unreachable_share(path); !folder.empty())
            return text(fmt::format(
                "the network folder '{}' cannot be reached; check its name and the network", folder));
        if (std::error_code ignored; fs::is_regular_file(first_bad_folder(path), ignored)) // as on Windows
            return output_error(path, ENOTDIR);
        if (std::error_code ignored; fs::is_directory(folder_of(path), ignored)) // such as /proc
            return text(
                fmt::format("the folder '{}' takes no new files; choose another place", folder_of(path)));
        return text(fmt::format("the folder '{}' does not exist; create it first", first_bad_folder(path)));
    case ENOTDIR:
        return text(
            fmt::format("'{}' is a file, not a folder; choose another place", first_bad_folder(path)));
    case EISDIR:
        return text("it is a folder; give the name of a file");
    case EACCES:
    case EPERM:
        return text(fmt::format("no permission in the folder '{}'; choose another place or change the "
                                "permissions",
                                folder_of(path)));
    case EROFS:
        return text("the file system is read-only; choose another place");
    case ENOSPC:
        return text("the disk is full; free some space or choose another place");
    case EFBIG:
        return text(
            "the file has become larger than the file system or the limit of this process allows (see "
            "ulimit -f)");
    case ENAMETOOLONG:
        return text("the name is too long; choose a shorter one");
    case ELOOP:
        return text("its symbolic links run in a circle");
    case ETXTBSY:
        return text("another program has the file open; close it there or choose another name");
    case EILSEQ:
        return text("the name has characters that this system does not permit; choose another one");
    case EPIPE:
        return text("the reader of the pipe has gone");
    case EBADF:
        return text("it is closed or not open for writing");
    case EMFILE:
    case ENFILE:
        return text("too many files are open (see ulimit -n)");
    case EIO:
        return text("the device reports an error; check the disk");
    default:
        return text(std::generic_category().message(system_error));
    }
}

void check_links(const std::string& path) {
    if (leads_through_foreign_link(path))
        throw Error(
            ErrorKind::output,
            fmt::format("cannot write '{}': its path leads through a link that another user made in a "
                        "folder that others can write; remove the link or choose another folder",
                        path),
            EPERM);
}

AtomicFile::AtomicFile(std::string path, Overwriting overwriting, std::string* memory)
    : path_(std::move(path)), memory_(memory) {
    if (memory_ != nullptr) {
        memory_->clear();
        return;
    }
    if (path_ == "-") {
        file_ = standard_output();
        owns_file_ = false;
        if (overwriting == Overwriting::yes)
            spool();
        return;
    }
    if (path_.empty())
        throw Error(ErrorKind::output, "cannot write a file without a name");
    refuse_device(path_);
    check_links(path_);
    OutputTarget target = find_target(path_);
    if (target.error != 0)
        fail(target.error);
    if (!target.in_place) {
        target_ = std::move(target.path);
        open_unfinished();
        return;
    }
    file_ = open_in_place(path_);
    if (!file_.is_open())
        fail(errno);
    if (overwriting == Overwriting::yes)
        spool();
}

AtomicFile::~AtomicFile() {
    discard();
}

void AtomicFile::spool() {
    spool_ = create_scratch(scratch_folder());
    if (!spool_.is_open())
        fail_spool(errno);
}

void AtomicFile::fail_spool(int system_error) {
    discard_alone();
    throw Error(ErrorKind::output,
                fmt::format("cannot write a temporary file in the folder '{}', where this output waits for "
                            "its end: {}; set the environment variable {} to a folder that can be "
                            "written and has room",
                            scratch_folder(), std::generic_category().message(system_error),
                            scratch_variable()),
                system_error);
}

void AtomicFile::open_unfinished() {
    const Replaces replaces = replaced_at(target_);
    if (replaces == Replaces::unknown)
        fail(errno);
    // A rename would replace a write-protected file, against the intention of its owner.
    if (replaces == Replaces::protected_file)
        throw Error(ErrorKind::output,
                    fmt::format("cannot write '{}': the file there is write-protected; remove it or choose "
                                "another name",
                                path_));
    file_ = create_nameless(folder_of(target_));
    if (file_.is_open())
        nameless_ = true;
    else if (errno == EOPNOTSUPP)
        open_named();
    else
        fail(errno);
    if (replaces == Replaces::file)
        keep_permissions(file_, target_);
}

void AtomicFile::open_named() {
    const UnfinishedName::Creation creation;
    temporary_ = take_free_name(target_, this_process(), [this](const char* name) {
        file_ = create_named(name);
        return file_.is_open();
    });
    if (temporary_.empty())
        fail(errno);
    announce();
}

void AtomicFile::give_temporary_name() {
    const UnfinishedName::Creation creation;
    temporary_ =
        take_free_name(target_, this_process(), [this](const char* name) { return name_file(file_, name); });
    if (temporary_.empty())
        fail(errno);
    nameless_ = false;
    announce();
}

void AtomicFile::announce() {
    if (unfinished_.announce(temporary_))
        return;
    discard();
    throw Error(ErrorKind::cancelled, "cancelled");
}

const std::string& AtomicFile::share() {
    if (nameless_)
        give_temporary_name();
    return temporary_;
}

void AtomicFile::check_open() {
    if (const int error = error_.load(std::memory_order_relaxed))
        fail(error);
    if (!file_.is_open() && memory_ == nullptr)
        throw Error(ErrorKind::internal, fmt::format("'{}' was written to after its end", path_));
}

void AtomicFile::append(std::string_view bytes) {
    check_open();
    if (!bytes.empty()) // an empty view may be a null pointer
        write(next_extent(bytes.size()), bytes);
}

void AtomicFile::append(std::string_view bytes, std::shared_ptr<const void> owner, Completions& after) {
    if (!has_positions() || bytes.size() < worth_a_completion)
        return append(bytes);
    check_open();
    promised_.fetch_add(1, std::memory_order_relaxed);
    after.emplace_back([this, extent = next_extent(bytes.size()), bytes, owner = std::move(owner)] {
        write(extent, bytes);
        promised_.fetch_sub(1, std::memory_order_relaxed);
    });
}

/// Returns a block from this offset to the next multiple of its size.
std::shared_ptr<AtomicFile::Block> AtomicFile::new_block(std::uint64_t begin) {
    auto block = std::make_shared<Block>();
    block->begin = begin;
    block->size = block_size - begin % block_size;
    block->missing = block->size;
    {
        const std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            block->bytes = std::move(idle_.back());
            idle_.pop_back();
        }
    }
    if (!block->bytes)
        block->bytes.reset(new char[block_size]); // unused pages take no memory
    return block;
}

/// Returns the place of the next `size` bytes, which then are appended.
AtomicFile::Extent AtomicFile::next_extent(std::size_t size) {
    Extent extent;
    extent.begin = bytes_.fetch_add(size, std::memory_order_relaxed);
    if (!last_ && extent.begin % block_size != 0)
        last_ = new_block(extent.begin);
    if (last_) {
        extent.first = last_;
        extent.in_first = std::min<std::size_t>(size, last_->begin + last_->size - extent.begin);
        if (extent.begin + extent.in_first < last_->begin + last_->size)
            return extent;
        last_ = nullptr;
    }
    extent.whole = (size - extent.in_first) / block_size * block_size;
    if (extent.in_first + extent.whole < size)
        extent.last = last_ = new_block(extent.begin + extent.in_first + extent.whole);
    return extent;
}

void AtomicFile::write(const Extent& extent, std::string_view bytes) {
    if (extent.first)
        fill(*extent.first, extent.begin, bytes.substr(0, extent.in_first));
    if (extent.whole > 0)
        write_out(extent.begin + extent.in_first, bytes.substr(extent.in_first, extent.whole));
    if (extent.last)
        fill(*extent.last, extent.last->begin, bytes.substr(extent.in_first + extent.whole));
}

/// Adds bytes at an offset of the file to their block, and writes it if it is complete.
void AtomicFile::fill(Block& block, std::uint64_t at, std::string_view bytes) {
    assert(block.begin <= at && at + bytes.size() <= block.begin + block.size);
    std::memcpy(block.bytes.get() + (at - block.begin), bytes.data(), bytes.size());
    // Whoever writes the block must see the bytes of all threads.
    if (block.missing.fetch_sub(bytes.size(), std::memory_order_acq_rel) != bytes.size())
        return;
    write_out(block.begin, {block.bytes.get(), block.size});
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(block.bytes));
}

/// Writes all that was appended. Requires that all completions are done.
void AtomicFile::flush() {
    const std::uint64_t end = bytes();
    if (const std::shared_ptr<Block> block = std::exchange(last_, nullptr)) {
        const std::size_t used = end - block->begin;
        if (block->missing == block->size - used)
            write_out(block->begin, {block->bytes.get(), used});
    }
    if (written_ != end)
        throw Error(ErrorKind::internal, fmt::format("bytes of '{}' were not written before its end", path_));
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
    check_open();
    flush();
    if (!write_at(offset, bytes))
        fail(errno);
}

/// Writes bytes at an offset. Returns false if the system failed.
bool AtomicFile::write_at(std::uint64_t offset, std::string_view bytes) {
    if (memory_ == nullptr)
        return write_all_at(spool_.is_open() ? spool_ : file_, offset, bytes);
    if (memory_->size() < offset + bytes.size())
        memory_->resize(offset + bytes.size());
    bytes.copy(memory_->data() + offset, bytes.size());
    return true;
}

// Copies the spool to the output; later writes go to the output directly.
void AtomicFile::copy_spool() {
    const NativeFile from = std::move(spool_);
    const std::unique_ptr<char[]> buffer(new char[block_size]);
    std::uint64_t offset = 0;
    for (;;) {
        const std::ptrdiff_t got =
            read_at(from, offset, {reinterpret_cast<std::byte*>(buffer.get()), block_size});
        if (got < 0)
            fail(errno);
        if (got == 0)
            return;
        write_out(offset, {buffer.get(), static_cast<std::size_t>(got)});
        offset += static_cast<std::uint64_t>(got);
    }
}

/// Writes bytes at an offset, or to the end of what is written in place.
void AtomicFile::write_out(std::uint64_t offset, std::string_view bytes) {
    // The system lets one thread at a time write to a file, and the others would wait for it with busy
    // processors.
    const std::lock_guard lock(writing_);
    if (!(has_positions() ? write_at(offset, bytes) : write_all(file_, bytes)))
        fail(errno);
    written_.fetch_add(bytes.size(), std::memory_order_relaxed);
}

void AtomicFile::commit() {
    check_open();
    flush();
    if (memory_ != nullptr) {
        memory_ = nullptr;
        return;
    }
    if (spool_.is_open())
        copy_spool();
    // Only a rename can take a name that is in use.
    if (nameless_)
        give_temporary_name();
    if (temporary_.empty()) {
        if (!owns_file_)
            file_.release();
        else if (!file_.close())
            fail(errno);
        return;
    }
    if (!close_and_rename(file_, temporary_, target_))
        fail(errno);
    temporary_.clear();
    unfinished_.withdraw();
}

void AtomicFile::discard() noexcept {
    if (!owns_file_)
        file_.release();
    file_.close();
    spool_.close();
    if (!temporary_.empty())
        remove_file(temporary_);
    temporary_.clear();
    nameless_ = false;
    unfinished_.withdraw();
}

/// Discards the file, unless other threads may be writing it; then the destructor does.
void AtomicFile::discard_alone() noexcept {
    if (promised_ == 0)
        discard();
}

void AtomicFile::fail(int system_error) {
    int none = 0;
    error_.compare_exchange_strong(none, system_error);
    if (spool_.is_open() && (system_error == ENOSPC || system_error == quota_error))
        fail_spool(system_error);
    discard_alone();
    throw output_error(target_.empty() ? path_ : target_, system_error);
}

void write_whole_file(const std::string& path, std::string_view bytes) {
    AtomicFile file(path);
    file.append(bytes);
    file.commit();
}

void check_writable(const std::string& path) {
    if (path != "-" && !find_target(path).in_place)
        static_cast<void>(AtomicFile(path));
}

} // namespace lamella
