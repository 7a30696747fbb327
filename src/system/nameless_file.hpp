#pragma once

// Files without a name: nothing of them is left however the process ends. And names for what is not finished.

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace lamella {

/// Opens a new file without a name in `folder`, for reading and writing. It can be named later. The
/// descriptor, which the caller closes; -1 and errno otherwise: EOPNOTSUPP where there are no such files or
/// where they cannot be named.
[[nodiscard]] int create_nameless(const std::string& folder, mode_t permissions);

/// The first hidden name beside `target`, `.NAME.OWNER-N.tmp`, that `take` makes its own: false and EEXIST
/// mean that it is in use. "" and errno where it fails for another reason.
[[nodiscard]] std::string take_free_name(const std::filesystem::path& target, std::string_view owner,
                                         const std::function<bool(const char* name)>& take);

/// The owner of names that belong to this process alone.
[[nodiscard]] std::string this_process();

/// Gives a file of `create_nameless` its name, once. False and errno otherwise: EEXIST where the name is in
/// use.
[[nodiscard]] bool name_file(int descriptor, const char* name);

/// Where scratch files lie: the folder that TMPDIR names, else /var/tmp, which is on a disk where /tmp may be
/// memory.
[[nodiscard]] std::string scratch_folder();

/// Like create_nameless, for what nobody else is to read and never gets a name: where the file system has no
/// files without one, it loses its own at once.
[[nodiscard]] int create_scratch(const std::string& folder);

} // namespace lamella
