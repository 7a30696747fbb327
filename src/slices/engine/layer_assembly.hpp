#pragma once

// Makes layers of parts from contours at heights, as slice files contain them.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/findings/findings.hpp"
#include "lamella/slices/layer_file.hpp"

#include "container/read_limits.hpp"
#include "core/counted.hpp"
#include "core/distinct_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// Warns of findings.
void append_to(const Findings& found, std::vector<std::string>& warnings);

/// Makes labels of parts suitable for messages and for other files.
class ReadLabels {
  public:
    /// Returns the label in printable form (see printable()), truncated to the largest length of a label.
    [[nodiscard]] std::string of(std::string_view label);
    /// Warns of labels that were changed.
    void append_to(std::vector<std::string>& warnings) const;

  private:
    std::uint64_t changed_ = 0;
    std::string first_; ///< first changed label, after the change
};

/// The contours and hatches at one height of the file, mm.
struct RawLayer {
    struct Contour {
        std::size_t end; ///< index in `points`
        bool closed;
        std::uint32_t part; ///< index in PlaneSource::parts
    };
    struct Hatches {
        std::size_t end; ///< index in `hatches`
        std::uint32_t part;
        std::size_t behind; ///< number of contours that precede these hatches in the file
    };

    /// Consecutive contours, or hatch lines, of one part and kind.
    struct Run {
        enum class Kind : std::uint8_t { ring, chain, hatch };

        std::uint32_t part;
        Kind kind;
        std::size_t begin; ///< indices in `points`, or in `hatches`
        std::size_t end;
        Box3 box; ///< of the points, at a height of 0
    };

    double z = 0;          ///< as in the file
    std::string location;  ///< for error messages
    std::size_t begin = 0; ///< offset from which it can be parsed again, in the file or its list of layers
    std::vector<std::size_t> joined; ///< those of layers that were appended
    std::vector<Point2> points;
    std::vector<Contour> ends;
    std::vector<Point2> hatches; ///< two points each
    std::vector<Hatches> hatch_ends;
    std::vector<Run> runs; ///< in the order of the file; set by `end_layer`
    bool drawn = false;    ///< the file has points for this layer, possibly only of dropped contours (Common
                           ///< Layer Interface)

    /// Returns the index in `points` of the first point of the contour under construction.
    [[nodiscard]] std::size_t contour_begin() const { return ends.empty() ? 0 : ends.back().end; }
    /// Returns whether the last point of this contour repeats its first one.
    [[nodiscard]] bool returns() const {
        return points.size() > contour_begin() && points.back() == points[contour_begin()];
    }

    /// Returns whether the contour may be a ring although the file calls it open.
    [[nodiscard]] bool is_returning_chain() const { return returns() && points.size() - contour_begin() > 3; }

    /// Ends the contour. Drops points equal to the one before, and the last point of a ring if it repeats the
    /// first one. If fewer than three points of a ring or two of a chain are left, drops the contour, adds it
    /// to `found` and returns false.
    template <class Location>
    bool end_contour(bool closed, std::uint32_t part, ReadLimits& limits, const Location& where,
                     Findings& found) {
        limits.make_room(ends, 1, where);
        const bool kept = keep_contour(closed, part);
        if (!kept)
            found.note(FindingKind::dropped_contours, where);
        return kept;
    }

    template <class Location>
    void end_hatches(std::uint32_t part, ReadLimits& limits, const Location& where) {
        limits.make_room(hatch_ends, 1, where);
        hatch_ends.push_back({hatches.size(), part, ends.size()});
    }

    /// Appends the contours and hatches of another layer of the same height.
    void append(const RawLayer& other);

    /// Finds the runs. Frees the contours and hatches unless planes are kept in memory.
    void end_layer(ReadLimits& limits);
    /// Replaces part i by numbers[i].
    void renumber(std::span<const std::uint32_t> numbers);

  private:
    bool keep_contour(bool closed, std::uint32_t part);
};

/// Numbers the parts of contours and hatches, identified by keys, in the order of their first occurrence.
/// Then puts the parts into the file in the order of their keys.
template <class Key>
class PartNumbers {
  public:
    explicit PartNumbers(ReadLimits& limits) : limits_(limits) {}

    [[nodiscard]] bool empty() const noexcept { return numbers_.empty(); }
    /// Returns the keys in ascending order, which is the order of the parts in the file.
    [[nodiscard]] std::vector<Key> keys() const {
        std::vector<Key> keys;
        for (const auto& [key, number] : numbers_)
            keys.push_back(key);
        return keys;
    }
    /// Returns the first key that is not less than this one, or null.
    [[nodiscard]] const Key* first_from(const Key& key) const {
        const auto found = numbers_.lower_bound(key);
        return found == numbers_.end() ? nullptr : &found->first;
    }

    template <class Location>
    std::uint32_t number_of(const Key& key, const Location& location) {
        if (last_ == nullptr || last_->first != key) {
            auto found = numbers_.find(key);
            if (found == numbers_.end()) {
                limits_.add_bytes_at(of_part, location);
                found = numbers_.emplace(key, static_cast<std::uint32_t>(numbers_.size())).first;
            }
            last_ = &*found;
        }
        return last_->second;
    }

    /// Numbers the parts of a piece of the file. `key_of(key)` returns the key for that of the piece.
    /// Replaces the part numbers of the layers of the piece, and gives back the bytes that its numbers were
    /// counted for.
    template <class KeyOf, class Location>
    void add(const PartNumbers& piece, std::span<RawLayer> layers, const KeyOf& key_of,
             const Location& location) {
        limits_.give_back(0, piece.numbers_.size() * of_part);
        std::vector<std::uint32_t> numbers(piece.numbers_.size());
        for (const auto& [key, number] : piece.numbers_)
            numbers[number] = number_of(key_of(key), location);
        renumber(layers, numbers);
    }

    /// Replaces the part numbers of a layer that is parsed again by indices of parts in the file, which has
    /// parts with these keys.
    void put(RawLayer& layer, const std::vector<Key>& keys) const {
        std::vector<std::uint32_t> locations(numbers_.size());
        for (const auto& [key, number] : numbers_)
            locations[number] =
                static_cast<std::uint32_t>(std::lower_bound(keys.begin(), keys.end(), key) - keys.begin());
        layer.renumber(locations);
    }

    /// Makes the parts by calling `part_of(key)`, and replaces the part numbers of contours and hatches by
    /// indices of parts in the file.
    template <class PartOf>
    void put(LayerFile& file, std::span<RawLayer> layers, const PartOf& part_of) const {
        std::vector<std::uint32_t> locations(numbers_.size());
        for (const auto& [key, number] : numbers_) {
            locations[number] = static_cast<std::uint32_t>(file.parts.size());
            file.parts.push_back(part_of(key));
        }
        renumber(layers, locations);
    }

  private:
    /// Bytes of the part and of temporary data for it.
    static constexpr std::uint64_t of_part = node_bytes + sizeof(Key) + 2 * sizeof(PartInfo);

    static void renumber(std::span<RawLayer> layers, const std::vector<std::uint32_t>& numbers) {
        for (RawLayer& layer : layers)
            layer.renumber(numbers);
    }

    ReadLimits& limits_;
    std::map<Key, std::uint32_t> numbers_;
    const std::pair<const Key, std::uint32_t>* last_ = nullptr;
};

/// Appends the layers of a piece of the file.
template <class Raw>
void append_layers(std::vector<Raw>& layers, std::vector<Raw>&& piece, ReadLimits& limits) {
    const std::uint64_t counted = piece.capacity() * sizeof(Raw);
    limits.make_room(layers, piece.size(), [&] {
        const std::string& location = piece.front().location;
        return location.empty() ? fmt::format("layer {}", layers.size()) : location;
    });
    std::move(piece.begin(), piece.end(), std::back_inserter(layers));
    piece = {};
    limits.give_back(0, counted);
}

/// Ends the layers of a piece of the file.
template <class Raw>
void end_layers(std::vector<Raw>& layers, ReadLimits& limits) {
    for (Raw& layer : layers)
        layer.end_layer(limits);
}

/// Returns the only layer that was parsed again.
template <class Raw>
[[nodiscard]] RawLayer only_layer(std::vector<Raw>&& layers) {
    assert(layers.size() == 1);
    return std::move(layers.front());
}

/// Consecutive layers of a file whose parts have keys.
template <class Key>
struct KeyedLayers {
    explicit KeyedLayers(ReadLimits& limits) : parts(limits) {}

    std::vector<RawLayer> layers;
    PartNumbers<Key> parts;
    Findings found;
    std::size_t end = 0; ///< where the next layer begins

    /// Appends the layers that follow.
    void append(KeyedLayers&& piece, ReadLimits& limits) {
        parts.add(
            piece.parts, piece.layers, [](const Key& key) { return key; },
            [&] { return std::string_view(piece.layers.front().location); });
        found.add(piece.found);
        append_layers(layers, std::move(piece.layers), limits);
        end = piece.end;
    }

    /// Returns the only layer, which was parsed again. The file has parts with these keys.
    [[nodiscard]] RawLayer only(const std::vector<Key>& keys) && {
        RawLayer layer = only_layer(std::move(layers));
        parts.put(layer, keys);
        return layer;
    }
};

/// Parses the layer that begins at an offset again, with indices of parts in the file. May be called by any
/// number of threads at once.
using ParseLayer = std::function<RawLayer(std::size_t begin, ReadLimits& limits)>;

/// Returns a file of which only this is known.
[[nodiscard]] LayerFile layer_file(const std::string& name, std::string_view format, double units_mm = 0);

/// Returns the name of the first parameter of scan vectors that is negative although it must not be; empty if
/// there is none.
[[nodiscard]] std::string_view negative_parameter(const ParameterSet& set);

/// Warns of names of parts that were changed.
void append_to(const DistinctNames& names, std::vector<std::string>& warnings);

/// Makes the parts of scan vectors. Those of one part of a machine's file have its label, which is unique.
class VectorParts {
  public:
    /// `part` identifies the part of the file.
    [[nodiscard]] PartInfo of(std::int64_t part, const std::string& label, std::optional<Exposure> exposure);

    ReadLabels labels;
    DistinctNames names;

  private:
    std::map<std::int64_t, std::string> known_; ///< labels
};

/// Number of bytes that an empty layer takes in addition to its struct: the list of offsets, and the owner of
/// the points.
inline constexpr std::uint64_t of_empty_layer = 128;

/// Returns approximately the memory that a plane takes while it is parsed: lists of points that grow, and two
/// copies of the points until its layers are made.
[[nodiscard]] constexpr std::uint64_t bytes_of_plane(std::uint64_t points) noexcept {
    constexpr std::uint64_t copies = 4;
    constexpr std::uint64_t few = std::uint64_t{1} << 16;
    return copies * points * sizeof(Point2) + few;
}

/// The index and the heights of a plane, and what the file has there.
struct PlacedLayer {
    RawLayer* raw = nullptr;
    std::uint64_t index = 0;
    double z = 0;
    double bottom = 0;
    double top = 0;
};

/// Gives the file, which has its parts, these planes. Layers of parts without an exposure are in normal form.
/// If planes are kept in memory, makes them on all threads and frees the contours and hatches of each
/// RawLayer; in the limits, the layers take their place. Otherwise planes are parsed again when they are
/// needed; the limits must live as long.
void add_layers(LayerFile& file, std::span<const PlacedLayer> planes, ReadLimits& limits,
                const Execution& execution, ParseLayer parse);

/// Adds layers whose heights are their tops. Each layer extends down to the top of the one before, the first
/// one to `bottom`. Cuts are assumed to be half-way up. Warns of layers in which the order of scan vectors
/// changes.
void add_layers_by_tops(LayerFile& file, std::span<RawLayer> layers, double bottom, ReadLimits& limits,
                        const Execution& execution, ParseLayer parse);
/// Adds layers whose heights are their bottoms in the same way; the last one extends up to `top`.
void add_layers_by_bottoms(LayerFile& file, std::span<RawLayer> layers, double top, ReadLimits& limits,
                           const Execution& execution, ParseLayer parse);

/// Throws Error{input} if the number of parts times the number of planes is implausibly large for the size of
/// the file, because even empty layers take memory. A few millions are accepted for any size, because a stack
/// of many small parts can have that many.
void check_part_planes(const LayerFile& file, std::uint64_t planes, std::uint64_t bytes);

/// Sorts layers by height and merges layers that are `same`, such as those of equal heights; warns if it
/// changed anything. `T` is a RawLayer with further data of the file.
template <class T, class Same>
void sort_by_height(std::vector<T>& layers, std::vector<std::string>& warnings, const Same& same) {
    const auto below = [](const T& a, const T& b) {
        return a.z < b.z;
    };
    if (!std::is_sorted(layers.begin(), layers.end(), below)) {
        const auto first = std::is_sorted_until(layers.begin(), layers.end(), below);
        warnings.push_back(
            fmt::format("layers do not ascend: z = {} mm follows z = {} mm ({}); they were sorted", first->z,
                        std::prev(first)->z, first->location));
        std::stable_sort(layers.begin(), layers.end(), below);
    }
    std::size_t kept = 0;
    std::size_t joined = 0;
    for (std::size_t i = 1; i < layers.size(); ++i) {
        if (same(layers[i], layers[kept])) {
            layers[kept].append(layers[i]);
            ++joined;
        } else if (++kept != i) {
            layers[kept] = std::move(layers[i]);
        }
    }
    assert(layers.empty() || kept + joined + 1 == layers.size());
    if (joined != 0) {
        layers.resize(kept + 1);
        warnings.push_back(counted(joined, "layer has the height of the one before; it was joined with that",
                                   "layers have the height of the one before; they were joined"));
    }
}
void sort_by_height(std::vector<RawLayer>& layers, std::vector<std::string>& warnings);

} // namespace lamella
