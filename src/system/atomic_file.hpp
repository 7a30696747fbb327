#pragma once

// Output that appears complete or not at all.

#include "lamella/core/commit.hpp"
#include "lamella/core/error.hpp"

#include "system/native_file.hpp"
#include "system/unfinished_name.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Returns the name of an output in messages: "standard output" for "-".
[[nodiscard]] std::string name_of_output(const std::string& path);

/// Returns the error for a path that could not be written: the path, the system's error (an errno) and
/// advice, in one line.
[[nodiscard]] Error output_error(const std::string& path, int system_error);

/// Throws Error{output} if the path leads through a link that another user planted (see
/// leads_through_foreign_link).
void check_links(const std::string& path);

/// Specifies whether appended bytes may be overwritten later.
enum class Overwriting : std::uint8_t { no, yes };

/// A file that gets its name when it is complete. Until then its bytes are in an unnamed file, which
/// disappears no matter how the process ends. If the file system does not support unnamed files, they are in
/// a file with a temporary name in the same folder, which this object removes. An existing file of that name
/// is replaced and its permissions are kept; a symbolic link stays, and the file that it points to is
/// replaced.
///
/// "-" is standard output. Standard output and files that are not regular (pipes, devices) are written in
/// place, because they can be neither renamed nor withdrawn.
///
/// The file is written in blocks at their positions. Threads that append large amounts one after the other
/// can write them at the same time: the position of bytes is determined in order, and the thread that made
/// them writes them there. Standard output and what else is written in place is written in order.
///
/// For one thread at a time, except `bytes` and the completions. All failures are Error{output}. After a
/// failure no file is left behind once this object is destroyed, and nothing more can be appended.
class AtomicFile {
  public:
    /// With Overwriting::yes, output that is written in place is kept in an unnamed temporary file until
    /// `commit`. If `memory` is not null, the bytes replace its content, and no file is made; the path is
    /// then only a name for errors.
    explicit AtomicFile(std::string path, Overwriting overwriting = Overwriting::no,
                        std::string* memory = nullptr);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Appends bytes. Small amounts are buffered; large ones are written at once, without a copy.
    void append(std::string_view bytes);
    /// Appends bytes that `owner` keeps alive. If they can be written later, adds to `after` the work that
    /// writes them, which must be done before `overwrite` and `commit`.
    void append(std::string_view bytes, std::shared_ptr<const void> owner, Completions& after);

    /// Replaces bytes that were appended before. Requires Overwriting::yes.
    void overwrite(std::uint64_t offset, std::string_view bytes);

    /// Writes the buffered bytes and gives the file its name. Must be called once, at the end.
    void commit();

    /// Returns the path as given.
    [[nodiscard]] const std::string& path() const noexcept { return path_; }
    /// Returns the number of bytes appended so far.
    [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
    /// Returns the temporary path of the file until `commit`, so that other processes can write some of its
    /// bytes; "" if the output is written in place. Gives an unnamed file a temporary name, which remains if
    /// the process is killed.
    [[nodiscard]] const std::string& share();

  private:
    /// A range of the file that is gathered in memory. Whoever adds its last bytes writes it.
    struct Block {
        std::uint64_t begin = 0; ///< offset in the file
        std::size_t size = 0;
        std::unique_ptr<char[]> bytes;
        std::atomic<std::size_t> missing{0}; ///< bytes that are not yet in memory
    };
    /// A range of appended bytes: the first ones belong to a block, the next ones are whole blocks, which
    /// need not be gathered, and the last ones begin another block.
    struct Extent {
        std::uint64_t begin = 0;
        std::size_t in_first = 0;
        std::size_t whole = 0;
        std::shared_ptr<Block> first;
        std::shared_ptr<Block> last;
    };

    [[nodiscard]] bool has_positions() const noexcept {
        return memory_ != nullptr || spool_.is_open() || !target_.empty();
    }
    void check_open();
    [[nodiscard]] std::shared_ptr<Block> new_block(std::uint64_t begin);
    [[nodiscard]] Extent next_extent(std::size_t size);
    void write(const Extent& extent, std::string_view bytes);
    [[nodiscard]] bool write_at(std::uint64_t offset, std::string_view bytes);
    void fill(Block& block, std::uint64_t at, std::string_view bytes);
    void open_unfinished();
    void open_named();
    void give_temporary_name();
    void announce();
    void spool();
    void copy_spool();
    void write_out(std::uint64_t offset, std::string_view bytes);
    void flush();
    void discard() noexcept;
    void discard_alone() noexcept;
    [[noreturn]] void fail(int system_error);
    /// Throws the error for the temporary file that stores the output.
    [[noreturn]] void fail_spool(int system_error);

    std::string path_;
    std::string* memory_;   ///< where the bytes go instead of a file; null if they do not, and after `commit`
    std::string target_;    ///< path_ with symbolic links resolved
    std::string temporary_; ///< the temporary name until `commit`; empty if there is none
    bool nameless_ = false; ///< true while the file has no name
    UnfinishedName unfinished_;
    NativeFile file_;
    NativeFile spool_; ///< the unnamed temporary file, if the output is kept in one
    bool owns_file_ = true;
    std::shared_ptr<Block> last_; ///< the block to which the next byte belongs; null if it begins a block
    std::mutex writing_;
    std::mutex mutex_;                          ///< for idle_
    std::vector<std::unique_ptr<char[]>> idle_; ///< memory of blocks that are written
    std::atomic<std::uint64_t> bytes_{0};
    std::atomic<std::uint64_t> written_{0};  ///< those of bytes_ that the system has
    std::atomic<std::uint64_t> promised_{0}; ///< completions that are not done
    std::atomic<int> error_{0};              ///< of the first failure
};

} // namespace lamella
