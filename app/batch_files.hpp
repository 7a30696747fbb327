#pragma once

// Which files a batch works on, and what their results are called.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace lamella::app {

/// What a batch is made of: a folder, of which all files of meshes are taken, those in folders within it,
/// too, ordered by path; or a list, one path a line in its order ("-": on standard input). A list that holds
/// a NUL is taken apart at those instead, as `find -print0` writes it. Empty lines and lines that begin with
/// # do not count; paths in a list are relative to the working folder.
///
/// Of a folder, hidden files and folders, links to folders, pipes, devices and what lies in `results` (where
/// that is another folder) are left out. A folder within it that cannot be listed stands among the files, to
/// fail as one of them.
///
/// Throws Error{input} where the source cannot be read or names nothing, and Error{usage} for a list with the
/// name of a mesh.
[[nodiscard]] std::vector<std::string> batch_inputs(const std::string& source, const std::string& results);

/// Throws Error{usage} where a result would be written over one of the inputs, or over another result, as
/// through a symbolic link.
void check_distinct(std::span<const std::string> inputs, std::span<const std::string> outputs);

/// Gives out names, none of them twice, nor one that is a folder of another.
class OutputNames {
  public:
    /// One for each input. `pattern` is a path with {name} (of the input, without its extension), {folder}
    /// (from the folder that all inputs share to the input's; "." where that is the same) or {index} (from 0)
    /// in it; without any of them it is a folder, in which the folders of the inputs are repeated, and
    /// `extension` is put behind the names.
    ///
    /// Where inputs would get the same name, all of them but the first get their own extension before the
    /// new one, and a number where that does not help: a.stl, a.obj: a.cli, a.obj.cli. The names depend on
    /// nothing but the inputs, their order, and what has been given out before.
    ///
    /// Throws Error{usage} for a placeholder that does not exist, and for names in the folder of a name that
    /// was given out before.
    [[nodiscard]] std::vector<std::string> give(std::span<const std::string> inputs,
                                                const std::string& pattern, std::string_view extension);

  private:
    [[nodiscard]] bool take(const std::string& name);
    void note_folders(const std::filesystem::path& name);

    std::unordered_set<std::string> taken_;
    std::unordered_set<std::string> folders_; ///< of what is taken
};

/// Whether `pattern` has a placeholder, else it is a folder.
[[nodiscard]] bool has_placeholder(std::string_view pattern) noexcept;

} // namespace lamella::app
