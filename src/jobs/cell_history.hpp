#pragma once

// Follows cells of layers upwards, and finds connected ones that never reach a rooted cell.

#include "lamella/core/point.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// A cell of a layer, of the material or of the space.
struct HistoryCell {
    bool rooted = false; ///< connected with the plate, or with the space outside, by itself
    bool marked = false; ///< see HistoryRegion::marked
    double area_mm2 = 0;
    Point2 centre = {};
};

/// Connected cells from the layer of the first one on, in layers below the one in which they become connected
/// with a rooted cell.
struct HistoryRegion {
    std::size_t first = 0; ///< position of the first layer
    std::size_t last = 0;
    Point2 centre = {};  ///< of the first cell
    double area_mm2 = 0; ///< of the first cell
    double largest_mm2 = 0;
    double volume_mm3 = 0;
    bool marked = false; ///< true if the first cell is
    bool joined = false; ///< false if no cell of the next layer continues the region
};

/// The fate of the younger of two regions that become connected.
enum class RegionMeeting : std::uint8_t {
    ends,   ///< it ends, as joined
    merges, ///< both are one region from then on
};

/// Holds the cells of one layer, and the regions.
class CellHistory {
  public:
    explicit CellHistory(RegionMeeting meeting) : meeting_(meeting) {}

    /// Adds the next layer. `links` are pairs of cells, of the layer before and of this one, that are
    /// connected. O(cells + links).
    void add(std::span<const HistoryCell> cells,
             std::span<const std::pair<std::uint32_t, std::uint32_t>> links, double thickness_mm);

    /// Returns all regions, by ascending first layer. Those that reach the last layer are `joined` if
    /// `opens_above`.
    [[nodiscard]] std::vector<HistoryRegion> finish(bool opens_above) &&;

  private:
    /// A connected component of the cells up to the last layer.
    struct Component {
        bool rooted = false;
        std::optional<std::size_t> region = {}; ///< the number of its region; none if it is rooted
        double area_mm2 = 0;                    ///< in the last layer
        bool continues = false;
    };

    void connect(Component& to, const Component& from);
    void end(const Component& component, bool joined);

    RegionMeeting meeting_;
    std::size_t layers_ = 0;
    std::vector<Component> components_;
    std::vector<std::uint32_t> component_of_; ///< for each cell of the last layer
    std::vector<HistoryRegion> regions_;
    std::vector<bool> merged_; ///< regions that are part of another one
};

} // namespace lamella
