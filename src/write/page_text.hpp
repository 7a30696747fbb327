#pragma once

// The frame of a page: the viewer's text around the data, and text that may stand in both.

#include "lamella/contour/exposure.hpp"
#include "lamella/core/point.hpp"
#include "lamella/write/layer_page.hpp"

#include "write/quoted.hpp"

#include <string>
#include <string_view>

namespace lamella {

/// What of the viewer stands before the data, and what after them. Throws Error{usage} where there is no
/// viewer, and Error{internal} where it has no place for data.
struct PageFrame {
    std::string_view head;
    std::string_view tail;
};
[[nodiscard]] PageFrame page_frame(const PageOptions& options);

/// [a,b,c] of what `tell` makes of each.
template <class Range, class Tell>
std::string json_list(const Range& range, const Tell& tell) {
    std::string text = "[";
    for (const auto& item : range) {
        if (text.size() > 1)
            text += ',';
        text += tell(item);
    }
    return text + ']';
}

/// The shortest text that reads back to the same number; null where it is not finite.
[[nodiscard]] std::string page_number(double value);
/// [[x,y,z],[x,y,z]], null for an empty box.
[[nodiscard]] std::string page_box(const Box3& box);
/// {"part":...,"region":...,"kind":...,"contour":...,"parameters":{...}}
[[nodiscard]] std::string exposure_json(const Exposure& exposure);
/// {"sections":[...],"places":[...]}
[[nodiscard]] std::string notes_json(const PageNotes& notes);

/// An element that holds JSON.
[[nodiscard]] std::string json_element(std::string_view id, std::string_view json);
/// An element that holds bytes, in Base64.
[[nodiscard]] std::string data_element(std::string_view bytes);

} // namespace lamella
