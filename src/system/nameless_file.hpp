#pragma once

// Unnamed files, which disappear no matter how the process ends, and temporary names for unfinished files.

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace lamella {

/// Opens a new unnamed file in `folder`, for reading and writing. It can be named later. Returns the
/// descriptor, which the caller must close. On failure returns -1 and sets errno, to EOPNOTSUPP if the system
/// has no such files or cannot name them.
[[nodiscard]] int create_nameless(const std::string& folder, mode_t permissions);

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
[[nodiscard]] bool name_file(int descriptor, const char* name);

/// Returns the folder for scratch files: that in the environment variable TMPDIR, else /var/tmp, which is on
/// a disk, whereas /tmp may be in memory; /tmp only if /var/tmp is not writable.
[[nodiscard]] std::string scratch_folder();

/// Opens a scratch file like create_nameless, but readable only by this user and never to be named. If the
/// file system has no unnamed files, creates a named one and removes its name at once.
[[nodiscard]] int create_scratch(const std::string& folder);

} // namespace lamella
