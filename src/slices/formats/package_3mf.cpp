#include "slices/formats/package_3mf.hpp"

#include "container/decimal.hpp"
#include "container/inflate.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace lamella::package_3mf {

PackageWriter::PackageWriter(const std::string& path, const LayerFileInfo& info, Holds holds,
                             std::string_view more_types)
    : OrderedWriter(info, holds), zip_(path, Overwriting::no, info.memory) {
    zip_.add("[Content_Types].xml",
             fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                         "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
                         "<Default Extension=\"rels\" "
                         "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
                         "<Default Extension=\"model\" "
                         "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>"
                         "{}</Types>\n",
                         more_types),
             ZipMethod::deflated);
    zip_.add("_rels/.rels",
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
             "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
             "<Relationship Id=\"model\" Target=\"/3D/3dmodel.model\" "
             "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>\n",
             ZipMethod::deflated);
}

Chunk PackageWriter::compressed(std::string_view text) {
    std::unique_ptr<Deflater> deflater;
    {
        const std::lock_guard lock(mutex_);
        if (!idle_.empty()) {
            deflater = std::move(idle_.back());
            idle_.pop_back();
        }
    }
    if (!deflater)
        deflater = std::make_unique<Deflater>();
    Chunk chunk{{}, text.size(), crc32_of(text)};
    deflater->append_chunk(text, chunk.bytes);
    chunk.bytes.shrink_to_fit();
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(deflater));
    return chunk;
}

std::string box_mesh(const Box3& box) {
    std::string text = "<mesh>\n<vertices>\n";
    for (const double z : {box.min.z, box.max.z})
        for (const auto& [x, y] : {Point2{box.min.x, box.min.y}, Point2{box.max.x, box.min.y},
                                   Point2{box.max.x, box.max.y}, Point2{box.min.x, box.max.y}})
            text += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", decimal_text(x), decimal_text(y),
                                decimal_text(z));
    text += "</vertices>\n<triangles>\n";
    constexpr std::array<std::array<int, 3>, 12> triangles{{{0, 2, 1},
                                                            {0, 3, 2},
                                                            {4, 5, 6},
                                                            {4, 6, 7},
                                                            {0, 1, 5},
                                                            {0, 5, 4},
                                                            {1, 2, 6},
                                                            {1, 6, 5},
                                                            {2, 3, 7},
                                                            {2, 7, 6},
                                                            {3, 0, 4},
                                                            {3, 4, 7}}};
    for (const auto& [a, b, c] : triangles)
        text += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", a, b, c);
    return text + "</triangles>\n</mesh>\n";
}

} // namespace lamella::package_3mf
