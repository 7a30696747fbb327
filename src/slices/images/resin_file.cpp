#include "slices/images/resin_file.hpp"

#include "lamella/core/error.hpp"

#include "slices/images/image_reader.hpp"
#include "slices/images/layer_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace lamella {

ResinFile::ResinFile(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options,
                     const ResinJobKind& kind, const ResinPrinter& printer, std::vector<RunCode> codes,
                     std::uint64_t head_bytes)
    : ResinWriter(info, options, kind, printer), codes_(std::move(codes)), head_bytes_(head_bytes),
      file_(path, Overwriting::yes, info.memory) {
    // An empty image, so that impossible options are reported before the first layer.
    drawing().draw(Plane(), [](auto, auto) {});
    const std::string block(std::size_t{1} << 16, '\0');
    for (std::uint64_t left = head_bytes_; left > 0;) {
        const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(left, block.size()));
        put(std::string_view(block).substr(0, size));
        left -= size;
    }
}

ResinWriter::DrawnLayer ResinFile::drawn(const Plane& plane, std::uint64_t index) {
    Images images;
    images.index = index;
    std::vector<RunEncoder> encoders;
    encoders.reserve(codes_.size());
    for (const RunCode& code : codes_) {
        images.files.push_back(buffer());
        encoders.emplace_back(code, *images.files.back());
    }
    const RasterAreas areas = drawing().draw(plane, [&](auto row, auto times) {
        for (RunEncoder& encoder : encoders)
            encoder.add(row, times);
    });
    for (RunEncoder& encoder : encoders)
        encoder.finish();
    images.lit = encoders.front().lit();
    finish_images(images);
    return {areas, [this, images = std::move(images)](const ResinLayer& layer, Completions& after) {
                put_layer(layer, images, after);
            }};
}

/// Several codes are images in black and white, from which readers make grey.
std::uint8_t ResinFile::read_back(std::uint8_t value) const noexcept {
    if (codes_.size() == 1)
        return codes_.front().read_back[value];
    const auto white = std::count_if(codes_.begin(), codes_.end(),
                                     [&](const RunCode& code) { return code.read_back[value] > 0; });
    return grey_of_sets(static_cast<std::size_t>(white), codes_.size());
}

void ResinFile::end_job(const ResinTotals& totals) {
    const std::string head = end_and_head(totals);
    assert(head.size() == head_bytes_);
    file_.overwrite(0, head);
    file_.commit();
}

void ResinFile::check_32_bits(std::uint64_t position) const {
    if (position > std::numeric_limits<std::uint32_t>::max())
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: would take more than the 4 GiB that its format can address; choose higher "
                        "layers or fewer levels of anti-aliasing",
                        name_of_output(file_.path())));
}

} // namespace lamella
