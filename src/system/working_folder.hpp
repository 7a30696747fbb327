#pragma once

// Folders that are written under a temporary name, for AtomicDirectory.

#include "system/native_file.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace lamella {

/// Returns the owner of hidden folders: all processes of this machine until it is rebooted. A lock shows
/// whether the process of a folder is still running. Other machines may share the disk but not the locks;
/// their folders have other names. If the system has no id for this, the owner is the process.
[[nodiscard]] std::string this_machine();

/// Creates a folder and locks it as long as `lock` is open; `lock` stays closed if the file system has no
/// locks. If a process that no longer runs has left a folder of this name, and `may_remove(name)`, it is
/// removed. Returns false and sets errno on failure, to EEXIST if the name is taken.
[[nodiscard]] bool create_locked(const char* name, NativeFile& lock,
                                 const std::function<bool(const char*)>& may_remove);

/// Gives the new folder the permissions of the one that it will replace, but this process may write into it.
/// Returns the permissions for `set_permissions`, when the new folder is complete; none if nothing is
/// replaced.
[[nodiscard]] std::optional<unsigned> take_permissions(const std::filesystem::path& replaced,
                                                       const std::filesystem::path& working);
void set_permissions(const std::filesystem::path& folder, unsigned permissions);

/// Renames a folder. `lock` is that of the folder, if it is locked. Replaces an empty folder, if the system
/// can; fails with ENOTEMPTY or EEXIST if there is another one.
[[nodiscard]] bool rename_folder(NativeFile& lock, const std::filesystem::path& folder,
                                 const std::filesystem::path& name);
/// Exchanges the names of two folders at once. Returns false if the system or the file system cannot do this.
[[nodiscard]] bool exchange_folders(const std::filesystem::path& one, const std::filesystem::path& other);

/// Returns whether the folder is a mount point, which cannot be replaced; bind mounts count.
[[nodiscard]] bool is_mount_point(const std::filesystem::path& folder);
/// Removes a folder with its content, even if it is not writable.
void remove_folder(const std::filesystem::path& folder);

} // namespace lamella
