#include "container/zip_writer.hpp"
#include "fixtures/expect_error.hpp"
#include "slices/images/png_stack.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace lamella::png_stack_cases {
namespace {

std::vector<std::string> images_in(std::initializer_list<const char*> names, const char* begin,
                                   std::uint64_t first) {
    const TemporaryFolder folder;
    ZipWriter writer(folder.file("a.zip"), Overwriting::no, nullptr);
    for (const char* const name : names)
        writer.add(name, "x", ZipMethod::stored);
    writer.finish();
    const ZipReader zip(open_bytes(folder.file("a.zip")), 0);
    std::vector<std::string> found;
    for (const ZipEntry* const entry : numbered_images(zip, begin, first))
        found.push_back(entry->name);
    return found;
}

TEST(PngStack, OrdersImagesByTheirNumbers) {
    EXPECT_EQ(images_in({"10.png", "2.png", "1.png", "3.png", "4.png", "5.png", "6.png", "7.png", "8.png",
                         "9.png", "preview.png", "3d.png", "x1.png"},
                        "", 1)
                  .back(),
              "10.png");
    EXPECT_EQ(images_in({"job00001.png", "job00000.png", "thumbnail/thumbnail400x400.png"}, "job", 0),
              (std::vector<std::string>{"job00000.png", "job00001.png"}));
}

TEST(PngStack, MissesImages) {
    test::expect_error(ErrorKind::input, {"found the image 3.png; number 2 is expected"}, [] {
        static_cast<void>(images_in({"1.png", "3.png"}, "", 1));
    });
    test::expect_error(ErrorKind::input, {"found no images of layers; a0.png is expected"},
                       [] { static_cast<void>(images_in({"1.png"}, "a", 0)); });
}

} // namespace
} // namespace lamella::png_stack_cases
