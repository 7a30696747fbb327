#pragma once

// Differences between the bodies that a slicer's configuration lists and those of the file.

#include "meshes/slicer_config.hpp"

#include <cstdint>
#include <span>

namespace lamella {

class Remarks;

/// Counts roles of bodies that are not there, and bodies without a listed role. Such a file was changed or
/// saved again by a program that does not know the configuration; a negative volume would be a solid then.
class RoleGaps {
  public:
    /// Counts the roles, other than that of a part, which the configuration gives in an absent object.
    void add_absent(std::uint32_t object, const SlicerObject& known);
    void add_absent(std::uint32_t object, MeshRole role);
    /// Compares volumes with the number of triangles of their mesh.
    void compare(std::uint32_t object, std::span<const VolumeRange> volumes, std::uint64_t triangles);
    /// Counts a component that the configuration does not list, though it lists others of the object.
    void add_unlisted_component(std::uint32_t object);

    /// Adds one remark for each kind of difference.
    void report(Remarks& remarks) const;

  private:
    struct Count {
        std::uint64_t count = 0;
        std::uint32_t object = 0; ///< of the first

        void add(std::uint64_t more, std::uint32_t of_object) {
            object = count == 0 ? of_object : object;
            count += more;
        }
    };

    Count absent_;
    MeshRole first_absent_ = MeshRole::part;
    Count triangles_;
    Count components_;
};

} // namespace lamella
