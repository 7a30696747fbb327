#pragma once

// The frame of a page, which is the text of the viewer around the data, and conversions to text.

#include "lamella/contour/exposure.hpp"
#include "lamella/core/point.hpp"
#include "lamella/slices/layer_page.hpp"

#include "container/quoted.hpp"

#include <string>
#include <string_view>

namespace lamella {

/// Text of the viewer before and after the data. page_frame throws Error{usage} if there is no viewer, and
/// Error{internal} if it has no placeholder for data.
struct PageFrame {
    std::string_view header;
    std::string_view tail;
};
[[nodiscard]] PageFrame page_frame(const PageOptions& options);

/// Returns "[a,b,c]" with the texts that `describe` returns for the items.
template <class Range, class Describe>
std::string json_list(const Range& range, const Describe& describe) {
    std::string text = "[";
    for (const auto& item : range) {
        if (text.size() > 1)
            text += ',';
        text += describe(item);
    }
    return text + ']';
}

/// Returns the shortest text that reads back to the same number; null if it is not finite.
[[nodiscard]] std::string page_number(double value);
/// Returns [[x,y,z],[x,y,z]], null for an empty box.
[[nodiscard]] std::string page_box(const Box3& box);
/// Returns {"part":...,"region":...,"kind":...,"contour":...,"parameters":{...}}
[[nodiscard]] std::string exposure_json(const Exposure& exposure);
/// Returns {"sections":[...],"places":[...]}
[[nodiscard]] std::string notes_json(const PageNotes& notes);

[[nodiscard]] std::string json_element(std::string_view id, std::string_view json);
/// Returns an element that contains bytes in Base64.
[[nodiscard]] std::string data_element(std::string_view bytes);

} // namespace lamella
