#pragma once

// Reads the slice stacks, the objects and the build of a model part of a 3MF package.

#include "meshes/three_mf_part.hpp"
#include "slices/engine/layer_assembly.hpp"
#include "system/byte_source.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace lamella {

class Executor;
class ReadLimits;

struct SliceText;

/// One slice, in the unit of its object, with the contours as written. If they are not in memory, only their
/// runs are, and the slice is read again when it is needed.
struct Slice {
    double top = 0;
    RawLayer raw;
    std::shared_ptr<const SliceText> text = {}; ///< where to read it again; null if it is in memory

    /// Returns the number of points of the contours.
    [[nodiscard]] std::size_t points() const;
    /// Reads the contours again. May be called by any number of threads at once.
    [[nodiscard]] RawLayer read_again(ReadLimits& limits) const;
};

struct SliceStack {
    double bottom = 0;
    std::vector<Slice> slices;

    [[nodiscard]] double top() const { return slices.empty() ? bottom : slices.back().top; }
};

struct SlicedObject {
    std::string name;
    std::shared_ptr<const SliceStack> stack; ///< null if it has none
    std::vector<ThreeMfUse> components;
    ThreeMfObjectType type = ThreeMfObjectType::model;
};

struct SliceModel {
    double unit_mm = 1;
    std::map<std::uint32_t, std::shared_ptr<const SliceStack>> stacks;
    std::map<std::uint32_t, SlicedObject> objects;
    std::vector<ThreeMfUse> items; ///< of the build
    std::vector<std::string> warnings;
};

/// Returns the stack that a <sliceref> refers to.
using FindSliceStack = std::function<std::shared_ptr<const SliceStack>(const ThreeMfElement& reference)>;

/// Returns the bytes that a copy of what is in memory of the contours takes.
[[nodiscard]] std::uint64_t contour_bytes(const RawLayer& raw);

/// Reads a part. All threads read its slices. `find` is called by this thread. If layers are not kept in
/// memory, nearly all slices are to be read again; then the limits must live as long as the stacks.
[[nodiscard]] SliceModel read_slice_model(const ByteSource& part, const FindSliceStack& find,
                                          ReadLimits& limits, Executor& executor);

} // namespace lamella
