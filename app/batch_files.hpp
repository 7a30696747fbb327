#pragma once

// Input files of a batch, and the names of its results.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace lamella::app {

/// Returns the files of a batch. The source is either a folder or a list. For a folder, its mesh files and
/// those of its subfolders are returned, ordered by path. A list has one path per line ("-" reads the list
/// from standard input); its order is kept. If it contains NUL characters, as from `find -print0`, it is
/// split at these instead. Empty lines and lines that begin with # are ignored; paths in a list are relative
/// to the working folder.
///
/// In folders, hidden files and folders, links to folders, pipes, devices and the contents of `results` (if
/// that is another folder) are skipped. A subfolder that cannot be listed is returned like a file, which
/// fails later.
///
/// Throws Error{input} if the source cannot be read or is empty, and Error{usage} if a list has the name of a
/// mesh file.
[[nodiscard]] std::vector<std::string> batch_inputs(const std::string& source, const std::string& results);

/// Throws Error{usage} if a result would overwrite one of the inputs or another result, for example through a
/// symbolic link.
void check_distinct(std::span<const std::string> inputs, std::span<const std::string> outputs);

/// Assigns unique names, none of which is a folder of another.
class OutputNames {
  public:
    /// Returns one name for each input. `pattern` is a path with placeholders: {name} is the name of the
    /// input without its extension, {folder} the path from the common folder of all inputs to that of the
    /// input ("." if they are equal), {index} its number from 0. A pattern without a placeholder is a folder,
    /// in which the folders of the inputs are repeated, and `extension` is appended to the names.
    ///
    /// If several inputs would get the same name, all but the first keep their own extension before the new
    /// one, and also get a number if necessary. For example, a.stl and a.obj become a.cli and a.obj.cli. The
    /// names depend only on the inputs, their order, and earlier names.
    ///
    /// Throws Error{usage} for an unknown placeholder, and for names within a folder that is an earlier name.
    [[nodiscard]] std::vector<std::string> give(std::span<const std::string> inputs,
                                                const std::string& pattern, std::string_view extension);

  private:
    [[nodiscard]] bool take(const std::string& name);
    void note_folders(const std::filesystem::path& name);

    std::unordered_set<std::string> taken_;
    std::unordered_set<std::string> folders_; ///< parent folders of names in taken_
};

/// Returns whether `pattern` has a placeholder; otherwise it is a folder.
[[nodiscard]] bool has_placeholder(std::string_view pattern) noexcept;

} // namespace lamella::app
