#include "slices/images/resin_archive.hpp"

#include "slices/images/png.hpp"

namespace lamella {

ResinWriter::DrawnLayer ResinArchive::drawn(const Plane& plane, std::uint64_t /*index*/) {
    const LayerImage image = images_.image(plane);
    return {image.areas,
            [this, image, text = described(plane.polylines)](const ResinLayer& layer, Completions& after) {
                note(layer, text);
                archive_.add_ready(image_name(layer), ZipMethod::stored, image.in_zip(), image.file, after);
            }};
}

void ResinArchive::end_job(const ResinTotals& totals) {
    add_entries(totals);
    archive_.finish();
}

void ResinArchive::add_preview(const ColourImage& whole, std::string_view name, std::uint32_t width,
                               std::uint32_t height) {
    ByteBuffer file;
    append_png(fitted(whole, width, height), file);
    archive_.add(name, file.view());
}

} // namespace lamella
