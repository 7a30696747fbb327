#pragma once

// The file that a path of an output leads to.

#include "system/native_file.hpp"

#include <string>

namespace lamella {

/// The file to be written for a path.
struct OutputTarget {
    std::string path;      ///< with symbolic links resolved; may not exist
    bool in_place = false; ///< true if it can be neither replaced nor renamed: a pipe, a device, an open file
    int error = 0;         ///< an errno if nothing can be written there
};
[[nodiscard]] OutputTarget find_target(const std::string& path);

/// Returns the device that the last part of a path names whatever its extension is, such as AUX for aux.cli, on
/// a system with such names; "" for other paths. The null device by its bare name is a path like any other.
[[nodiscard]] std::string device_named(const std::string& path);

/// Throws Error{output} if a path names a device so.
void refuse_device(const std::string& path);

/// Returns whether the path leads through a symbolic link that another user made in a folder that others can
/// write. Such a link could lead the output of this user to any of their files. Links that the owner of the
/// folder made are trusted.
[[nodiscard]] bool leads_through_foreign_link(const std::string& path);

enum class Replaces : std::uint8_t {
    nothing,        ///< there is no file
    file,           ///< there is one
    protected_file, ///< there is one that its owner protected against writing
    unknown,        ///< failed, errno is set
};
/// Returns what a file renamed to this path would replace.
[[nodiscard]] Replaces replaced_at(const std::string& target);

/// Gives the replacement of an existing file the permissions of that file, as far as this process may.
void keep_permissions(const NativeFile& replacement, const std::string& target);

/// Returns the permissions of a replacement for a file with permissions `mode` of POSIX. `same_group` states
/// whether the replacement has the same group; if not, permissions of the group are dropped.
[[nodiscard]] constexpr unsigned kept_permissions(unsigned mode, bool same_group) noexcept {
    constexpr unsigned all = 07777;
    constexpr unsigned of_group = 02070; // set-group-ID, and read, write, execute
    return mode & (same_group ? all : all & ~of_group);
}

} // namespace lamella
