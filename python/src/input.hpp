#pragma once

// Files to read, as Python passes them.

#include "lamella/meshes/mesh_file.hpp"

#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace lamella::python {

/// A file to read: a path, or the content of an object such as bytes. Must be made and destroyed with the
/// interpreter lock.
class Input {
  public:
    /// `source` is a path, as bytes, or a pair: the name of an object in errors, and its content.
    explicit Input(const pybind11::object& source);

    /// Returns the path, or the name of the object.
    [[nodiscard]] const std::string& name() const noexcept { return name_; }

    /// Returns read(path), or read(bytes, name).
    template <class Read>
    [[nodiscard]] auto read_by(const Read& read) const {
        return content_ ? read(std::span(static_cast<const std::byte*>(content_->buf),
                                         static_cast<std::size_t>(content_->len)),
                               name_)
                        : read(name_);
    }

    /// Gives meshes of an object the label of meshes of arrays where those of a file are labelled by its
    /// name.
    void label(MeshFile& file) const;

  private:
    std::string name_;
    std::shared_ptr<Py_buffer> content_; ///< null for a path
};

} // namespace lamella::python
