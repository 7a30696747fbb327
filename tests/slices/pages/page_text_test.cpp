#include "lamella/core/error.hpp"

#include "container/json_text.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "page_reader.hpp"
#include "slices/pages/page_text.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace lamella::page_text_cases {
namespace {

TEST(PageText, FramesTheDataByTheViewer) {
    PageOptions options;
    options.viewer = "a<!--lamella-data-->b";
    const PageFrame frame = page_frame(options);
    EXPECT_EQ(frame.header, "a");
    EXPECT_EQ(frame.tail, "b");
    options.viewer = "ab";
    EXPECT_THROW(static_cast<void>(page_frame(options)), Error);
    options.viewer = "";
    options.no_viewer = "it was left out";
    test::expect_error(ErrorKind::usage, {"there is no viewer", "it was left out"},
                       [&] { static_cast<void>(page_frame(options)); });
}

TEST(PageText, WritesNumbersThatReadBack) {
    test::Random random(691);
    for (int i = 0; i < 1000; ++i) {
        const double value = random.real(-1e6, 1e6);
        EXPECT_EQ(std::strtod(page_number(value).c_str(), nullptr), value);
    }
    EXPECT_EQ(page_number(std::numeric_limits<double>::quiet_NaN()), "null");
    EXPECT_EQ(page_number(std::numeric_limits<double>::infinity()), "null");
    EXPECT_EQ(page_box({}), "null");
    Box3 box;
    box.add(Point3{1, 2, 3});
    box.add(Point3{4, 5, 6.5});
    EXPECT_EQ(page_box(box), "[[1,2,3],[4,5,6.5]]");
}

TEST(PageText, IsJsonThatNoTextCanLeave) {
    const std::string hostile = "</script><script>\"\\\n\xFF";
    PageNotes notes;
    notes.sections.push_back({hostile, {{hostile, hostile, Tone::bad}}});
    notes.locations.push_back({hostile, hostile, {{1, 2, 3}}, true, 7});
    Exposure exposure;
    exposure.part = hostile;
    exposure.parameters.name = hostile;
    for (const std::string& json : {notes_json(notes), exposure_json(exposure)}) {
        JsonText text(json, "x");
        text.skip();
        text.end();
        EXPECT_EQ(json.find('<'), std::string::npos) << json;
        const ReadPage page = read_page(json_element("id", json));
        EXPECT_EQ(page.scripts, 1U);
        EXPECT_EQ(page.json.at("id"), json);
    }
}

TEST(PageText, HoldsBytesInOneElement) {
    std::string bytes;
    for (int i = 0; i < 1000; ++i)
        bytes += static_cast<char>(i * 37);
    const std::string element = data_element(bytes);
    const std::size_t begin = element.find('>') + 1;
    EXPECT_EQ(base64_bytes(std::string_view(element).substr(begin, element.find("</script") - begin)), bytes);
}

} // namespace
} // namespace lamella::page_text_cases
