#pragma once

// Unnamed files, which disappear no matter how the process ends, and temporary names for unfinished files.

#include "system/native_file.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace lamella {

/// Opens a new unnamed file in `folder`, for reading and writing. It can be named later. On failure the
/// result is not open and errno is set, to EOPNOTSUPP if the system has no such files or cannot name them.
/// (On Windows the file has a hidden name, but the system removes it when it is closed.)
[[nodiscard]] NativeFile create_nameless(const std::string& folder);
/// Opens a new file of this name, for writing. Fails with EEXIST if the name is in use.
[[nodiscard]] NativeFile create_named(const char* name);

/// Tries hidden names `.NAME.OWNER-N.tmp` in the folder of `target` until `take` returns true for one, and
/// returns this name. If `take` returns false and sets errno to EEXIST, the name is in use, and the next one
/// is tried; for EINTR the same one is tried again. Returns "" for any other errno, or if all names are in
/// use.
[[nodiscard]] std::string take_free_name(const std::filesystem::path& target, std::string_view owner,
                                         const std::function<bool(const char* name)>& take);

/// Returns the owner for names that belong to this process alone.
[[nodiscard]] std::string this_process();

/// Gives a file of `create_nameless` its name. May be called once. On failure returns false and sets errno,
/// to EEXIST if the name is in use.
[[nodiscard]] bool name_file(const NativeFile& file, const char* name);
/// Closes a file and gives it another name, which may be in use.
[[nodiscard]] bool close_and_rename(NativeFile& file, const std::string& name, const std::string& target);
/// Removes a file, if it exists.
void remove_file(const std::string& name) noexcept;

/// Returns the folder for scratch files. On POSIX this is the one in the environment variable TMPDIR, else
/// /var/tmp, which is on a disk, whereas /tmp may be in memory; /tmp only if /var/tmp is not writable. On
/// Windows it is the one in TMP or TEMP.
[[nodiscard]] std::string scratch_folder();
/// Returns the environment variable that sets this folder.
[[nodiscard]] std::string_view scratch_variable() noexcept;

/// Opens a scratch file like create_nameless, but readable only by this user and never to be named. If the
/// file system has no unnamed files, creates a named one and removes its name at once.
[[nodiscard]] NativeFile create_scratch(const std::string& folder);

} // namespace lamella
