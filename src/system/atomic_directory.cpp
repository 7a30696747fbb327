#include "system/atomic_directory.hpp"

#include "system/atomic_file.hpp"
#include "system/nameless_file.hpp"
#include "system/output_target.hpp"
#include "system/working_folder.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

namespace lamella {

namespace fs = std::filesystem;

AtomicDirectory::AtomicDirectory(std::string path, std::function<bool(const fs::path&)> may_remove)
    : path_(std::move(path)), may_remove_(std::move(may_remove)) {
    check_links(path_);
    std::error_code error;
    if (!path_.empty())                               // standard libraries differ for an empty path
        target_ = fs::weakly_canonical(path_, error); // follows symbolic links, which are kept
    if (error || target_.empty())                     // one that forgets its error has no result
        target_ = path_;
    if (!target_.has_filename()) // "out/"
        target_ = target_.parent_path();
    if (target_.empty())
        throw Error(ErrorKind::output, "cannot write a folder without a name");
    refuse_device(path_);
    check_replaceable();
    const UnfinishedName::Creation creation;
    working_ = take_free_name(target_, this_machine(), [this](const char* name) {
        return create_locked(name, lock_, [this](const char* left) { return is_left_by_a_run(left); });
    });
    if (working_.empty())
        throw output_error(target_.string(), errno);
    permissions_ = take_permissions(target_, working_);
    if (!unfinished_.announce(working_.string())) {
        lock_.close();
        remove_folder(working_);
        throw Error(ErrorKind::cancelled, "cancelled");
    }
}

AtomicDirectory::~AtomicDirectory() {
    if (working_.empty())
        return;
    lock_.close(); // some systems do not remove a folder that is open
    remove_folder(working_);
}

void AtomicDirectory::check_replaceable() const {
    std::error_code error;
    const fs::file_status status = fs::status(target_, error);
    if (status.type() == fs::file_type::not_found)
        return;
    if (status.type() == fs::file_type::none)
        throw output_error(path_, error.value());
    if (!fs::is_directory(status))
        throw Error(ErrorKind::output,
                    fmt::format("cannot write '{}': it is a file, and the layers go into a folder; choose "
                                "another name",
                                path_));
    if (is_mount_point(target_))
        throw Error(ErrorKind::output,
                    fmt::format("cannot write '{}': it is a mount point, which nothing can replace; choose a "
                                "folder in it, such as '{}'",
                                path_, (target_ / "layers").string()));
    // Another process may have replaced the folder and may be removing the old one. So entries that no longer
    // exist are not foreign, and each name is tested twice, because one test may see both folders.
    const auto is_foreign = [this](const fs::path& entry) {
        std::error_code ignored;
        // An entry that cannot be examined exists.
        return !may_remove_(entry) && fs::symlink_status(entry, ignored).type() != fs::file_type::not_found;
    };
    fs::directory_iterator entries(target_, error);
    for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
        if (is_foreign(entries->path()) && is_foreign(entries->path()))
            throw Error(ErrorKind::output,
                        fmt::format("cannot write '{}': the folder holds something else ('{}'); empty it or "
                                    "choose another name",
                                    path_, entries->path().filename().string()));
    }
    if (error && error != std::errc::no_such_file_or_directory)
        throw output_error(path_, error.value());
}

bool AtomicDirectory::is_left_by_a_run(const char* folder) const {
    std::error_code error;
    fs::directory_iterator entries(folder, error);
    for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
        if (!may_remove_(entries->path()) && !is_unfinished_name(entries->path()))
            return false;
    }
    return !error;
}

void AtomicDirectory::write(const std::string& name, std::string_view bytes) {
    try {
        AtomicFile file((working_ / name).string());
        file.append(bytes);
        file.commit();
    } catch (const Error& error) {
        // The user does not know the temporary name of the folder.
        std::string text = error.what();
        const std::string working = working_.string();
        for (std::size_t at = 0; (at = text.find(working, at)) != std::string::npos;)
            text.replace(at, working.size(), target_.string());
        throw Error(error.kind(), text, error.system_error());
    }
    bytes_.fetch_add(bytes.size(), std::memory_order_relaxed);
}

void AtomicDirectory::commit() {
    if (working_.empty())
        throw Error(ErrorKind::internal, fmt::format("'{}' was ended twice", path_));
    // Once the folder has its final name, remove_unfinished must not remove its contents.
    if (!unfinished_.withdraw())
        throw Error(ErrorKind::cancelled, "cancelled");
    if (permissions_)
        set_permissions(working_, *permissions_);
    // If the target is missing or an empty folder, renaming is enough.
    if (rename_folder(lock_, working_, target_)) {
        working_.clear();
        return;
    }
    if (errno != ENOTEMPTY && errno != EEXIST)
        throw output_error(target_.string(), errno);
    check_replaceable();
    // Both folders exchange their names at once, so that one of them exists at all times.
    if (exchange_folders(working_, target_)) {
        remove_folder(std::exchange(working_, {}));
        return;
    }
    // Not every file system supports the exchange. Otherwise the old folder is renamed first; if the new
    // folder cannot get its name, the old one gets it back.
    const fs::path aside = take_free_name(target_, this_process(), [this](const char* name) {
        if (NativeFile no_lock; !fs::exists(fs::symlink_status(name)))
            return rename_folder(no_lock, target_, name);
        errno = EEXIST;
        return false;
    });
    if (aside.empty())
        throw output_error(target_.string(), errno);
    if (!rename_folder(lock_, working_, target_)) {
        const int system_error = errno;
        if (NativeFile no_lock; !rename_folder(no_lock, aside, target_))
            throw Error(ErrorKind::output,
                        fmt::format("cannot write '{}': what was there is now '{}'", path_, aside.string()));
        throw output_error(target_.string(), system_error);
    }
    working_.clear();
    remove_folder(aside);
}

bool is_unfinished_name(const fs::path& path) {
    const std::string name = path.filename().string();
    return name.starts_with('.') && name.ends_with(".tmp");
}

bool begins_with_magic(const fs::path& path, std::string_view mark) {
    std::error_code ignored;
    if (!fs::is_regular_file(fs::symlink_status(path, ignored)))
        return false;
    std::string begin(mark.size(), '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return file && begin == mark;
}

} // namespace lamella
