#include "meshes/role_gaps.hpp"

#include "core/counted.hpp"
#include "meshes/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace lamella {

void RoleGaps::add_absent(std::uint32_t object, const SlicerObject& known) {
    for (const VolumeRange& volume : known.volumes)
        add_absent(object, volume.role);
    for (const SlicerPart& part : known.parts)
        add_absent(object, part.role);
}

void RoleGaps::add_absent(std::uint32_t object, MeshRole role) {
    if (role == MeshRole::part) // which a body without a role is, too
        return;
    first_absent_ = absent_.count == 0 ? role : first_absent_;
    absent_.add(1, object);
}

void RoleGaps::compare(std::uint32_t object, std::span<const VolumeRange> volumes, std::uint64_t triangles) {
    std::vector<VolumeRange> ordered(volumes.begin(), volumes.end());
    std::sort(ordered.begin(), ordered.end(),
              [](const VolumeRange& a, const VolumeRange& b) { return a.begin < b.begin; });
    std::uint64_t done = 0;
    std::uint64_t unlisted = 0;
    for (const VolumeRange& volume : ordered) {
        if (volume.end > triangles)
            add_absent(object, volume.role);
        const std::uint64_t begin = std::min(volume.begin, triangles);
        unlisted += begin > done ? begin - done : 0;
        done = std::max(done, std::min(volume.end, triangles));
    }
    unlisted += triangles - done;
    if (unlisted != 0 && !volumes.empty())
        triangles_.add(unlisted, object);
}

void RoleGaps::add_unlisted_component(std::uint32_t object) {
    components_.add(1, object);
}

void RoleGaps::report(Remarks& remarks) const {
    constexpr std::string_view cure =
        "the file was changed since; save it again in the program that wrote the roles";
    if (absent_.count != 0)
        remarks.add(fmt::format("the roles of {} are for triangles or objects that are not in the file (the "
                                "first: a {} of object {}): {}",
                                counted(absent_.count, "body", "bodies"), row_of(first_absent_).name,
                                absent_.object, cure));
    const auto report_unlisted = [&](const Count& unlisted, std::string_view one, std::string_view many) {
        if (unlisted.count != 0)
            remarks.add(fmt::format("{} of objects whose roles the file lists (the first: object {}): {}",
                                    counted(unlisted.count, one, many), unlisted.object, cure));
    };
    report_unlisted(triangles_, "triangle without a role, taken as one of a part,",
                    "triangles without a role, taken as those of parts,");
    report_unlisted(components_, "component without a role, taken as a part,",
                    "components without a role, taken as parts,");
}

} // namespace lamella
