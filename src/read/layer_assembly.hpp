#pragma once

// From contours at heights, as slice files hold them, to layers.

#include "lamella/contour/layer.hpp"
#include "lamella/read/layer_file.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lamella {

/// Counts of one kind of oddity, said once for the whole file.
class Oddity {
  public:
    explicit Oddity(const char* what) : what_(what) {}

    /// `place` is only made for the first one.
    template <class Place>
    void note(const Place& place) {
        if (count_++ == 0)
            first_ = place();
    }
    /// "3 contours were not closed; they were closed (first at byte 120)"
    void say(std::vector<std::string>& warnings) const;

  private:
    const char* what_;
    std::uint64_t count_ = 0;
    std::string first_;
};

/// The contours of one height of the file, in millimetres.
struct RawLayer {
    double z = 0;      ///< as the file has it
    std::string place; ///< for error texts
    std::vector<Point2> points;
    std::vector<std::pair<std::size_t, bool>>
        ends; ///< the end of each contour in `points`, and whether it is closed

    void end_contour(bool closed) { ends.emplace_back(points.size(), closed); }
};

/// A layer in normal form; `raw` is left empty.
[[nodiscard]] Layer make_layer(RawLayer& raw, std::uint64_t index, double z, double bottom, double top);

/// Puts heights in ascending order and joins equal ones; warns when it had to.
void sort_by_height(std::vector<RawLayer>& layers, std::vector<std::string>& warnings);

} // namespace lamella
