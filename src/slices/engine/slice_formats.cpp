#include "slices/engine/slice_formats.hpp"

#include "lamella/slices/layer_page.hpp"

#include "slices/engine/layer_writers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

namespace {

std::unique_ptr<LayerWriter> open_page(const std::string& path, const LayerFileInfo& info,
                                       const LayerWriteOptions& options) {
    return open_layer_page(path, info, options.page);
}

constexpr Rounding unrounded{};

/// Advice for users who slice such a file.
constexpr std::string_view resin_job = "is a job for a resin printer: it holds images of layers already, no "
                                       "mesh; view, convert or verify it as it is";

constexpr std::array rows{
    SliceFormat{
        .writer = {.name = "cli",
                   .extension = ".cli",
                   .summary =
                       "Common Layer Interface, binary; single precision, or 16 bits in the short form",
                   .open = open_common_layer_binary,
                   .chunks = true,
                   .joins = true,
                   .rounding = Rounding{.single_precision = true},
                   .units = true,
                   .short_form = true},
        .recognises = is_common_layer,
        .read = read_common_layer,
        .first_bytes = "$$",
        .signature = "Common Layer Interface ($$HEADERSTART)",
        .advice = "is a slice file (Common Layer Interface): it holds layers already, no mesh; view, convert "
                  "or verify it as it is"},
    SliceFormat{.writer = {.name = "cli-ascii",
                           .extension = "",
                           .summary = "Common Layer Interface, ASCII; coordinates in whole units of 0.001 mm",
                           .open = open_common_layer_ascii,
                           .file_extension = ".cli",
                           .chunks = true,
                           .joins = true,
                           .rounding = Rounding{.step_mm = LayerWriteOptions::usual_units_mm},
                           .units = true}},
    SliceFormat{
        .writer = {.name = "svg",
                   .extension = ".svg",
                   .summary = "all layers in one SVG file as Slic3r writes it; coordinates to 0.001 mm",
                   .open = open_layered_svg,
                   .chunks = true,
                   .cuts = true,
                   .rounding = text_rounding},
        .recognises = is_svg,
        .read = read_layered_svg,
        .signature = "layered SVG (<svg)",
        .advice = "is an SVG document, which may hold layers, but no mesh; view, convert or verify layers as "
                  "they are"},
    SliceFormat{
        .writer = {.name = "slc",
                   .extension = ".slc",
                   .summary = "SLC of 3D Systems, binary; single precision; closed contours only",
                   .open = open_slc,
                   .rounding = Rounding{.single_precision = true}},
        .recognises = is_slc,
        .read = read_slc,
        .first_bytes = "-slc",
        .signature = "SLC (-SLCVER)",
        .advice =
            "is a slice file (SLC): it holds layers already, no mesh; view, convert or verify it as it is"},
    SliceFormat{.writer = {.name = "3mf",
                           .extension = ".3mf",
                           .summary = "3MF with slice stacks; coordinates to 0.001 mm; closed contours only",
                           .open = open_slices_3mf,
                           .rounding = text_rounding},
                .in_archive = is_3mf,
                .read_archive = read_slices_3mf},
    SliceFormat{.writer = {.name = "dxf",
                           .extension = ".dxf",
                           .summary = "DXF of AutoCAD Release 12, polylines; coordinates to 0.001 mm",
                           .open = open_dxf,
                           .chunks = true,
                           .one_way = true,
                           .cuts = true,
                           .rounding = text_rounding}},
    SliceFormat{.writer = {.name = "geojson",
                           .extension = ".geojson",
                           .summary = "GeoJSON, one feature per layer; coordinates to 0.001 mm",
                           .open = open_geojson,
                           .chunks = true,
                           .one_way = true,
                           .cuts = true,
                           .rounding = text_rounding}},
    SliceFormat{.writer = {.name = "json",
                           .extension = ".json",
                           .summary = "all that layers have as JSON; exact",
                           .open = open_layers_json,
                           .chunks = true,
                           .cuts = true,
                           .rounding = unrounded},
                .recognises = is_json,
                .read = read_layers_json,
                .signature = "JSON of layers ({)",
                .advice = "is a JSON document, which may hold layers, but no mesh that is read here; view, "
                          "convert or verify layers as they are"},
    SliceFormat{.writer = {.name = "npz",
                           .extension = ".npz",
                           .summary = "NumPy arrays; exact",
                           .open = open_npz,
                           .cuts = true,
                           .rounding = unrounded},
                .in_archive = is_npz,
                .read_archive = read_npz,
                .advice = "is a slice file (NumPy arrays): it holds layers already, no mesh; view, convert "
                          "or verify it as it is"},
    SliceFormat{
        .writer = {.name = "raw",
                   .extension = "",
                   .summary = "arrays of one layer after the other, for programs that read a pipe; exact",
                   .open = open_raw,
                   .file_extension = ".layers",
                   .one_way = true,
                   .cuts = true,
                   .rounding = unrounded}},
    SliceFormat{
        .writer = {.name = "ilt",
                   .extension = ".ilt",
                   .summary =
                       "scan vectors in binary Common Layer Interface files, with their parameters, zipped",
                   .open = open_ilt,
                   .filled_parts = true,
                   .rounding = Rounding{.single_precision = true},
                   .units = true,
                   .short_form = true},
        .in_archive = is_ilt,
        .read_archive = read_ilt,
        .advice = "holds scan vectors (ILT): layers already, no mesh; view, convert or verify it as it is"},
    SliceFormat{
        .writer = {.name = "ovf",
                   .extension = ".ovf",
                   .summary =
                       "scan vectors with their parameters in the Open Vector Format; single precision",
                   .open = open_ovf,
                   .filled_parts = true,
                   .rounding = Rounding{.single_precision = true}},
        .recognises = is_ovf,
        .read = read_ovf,
        .signature = "Open Vector Format (LVF!)",
        .advice = "holds scan vectors (Open Vector Format): layers already, no mesh; view, convert or verify "
                  "it as it is"},
    SliceFormat{
        .writer = {.name = "3mf-toolpath",
                   .extension = "",
                   .summary =
                       "scan vectors with their parameters, 3MF with toolpaths; whole units of 0.001 mm",
                   .open = open_toolpath_3mf,
                   .file_extension = ".build.3mf",
                   .filled_parts = true,
                   .rounding = Rounding{.step_mm = LayerWriteOptions::usual_units_mm},
                   .units = true},
        .in_archive = is_toolpath_3mf,
        .read_archive = read_toolpath_3mf},
    SliceFormat{.writer = {.name = "html",
                           .extension = ".html",
                           .summary = "a page to look at the layers with any browser; see docs/viewer.md",
                           .open = open_page,
                           .one_way = true,
                           .cuts = true}},
    SliceFormat{.writer = {.name = "svg-layers",
                           .extension = "",
                           .summary = "a folder with one SVG image per layer; coordinates to 0.001 mm",
                           .open = open_svg_layers,
                           .directory = true,
                           .one_way = true,
                           .cuts = true,
                           .rounding = text_rounding}},
    SliceFormat{.writer = {.name = "png",
                           .extension = "",
                           .summary = "a folder with one PNG image per layer; as fine as its pixels",
                           .open = open_image_folder,
                           .directory = true,
                           .one_way = true,
                           .cuts = true,
                           .image = true,
                           .part_colours = true}},
    SliceFormat{.writer = {.name = "png-zip",
                           .extension = ".zip",
                           .summary = "the same images in a zip archive",
                           .open = open_image_archive,
                           .cuts = true,
                           .image = true,
                           .part_colours = true},
                .in_archive = is_image_archive,
                .read_archive = read_image_archive},
    SliceFormat{.writer = {.name = "sl1",
                           .extension = ".sl1",
                           .summary = "a job for the resin printer Original Prusa SL1; as fine as its pixels",
                           .open = open_sl1,
                           .image = true,
                           .exposure = true},
                .in_archive = is_sl1,
                .read_archive = read_sl1},
    SliceFormat{.writer = {.name = "sl1s",
                           .extension = ".sl1s",
                           .summary = "the same for the SL1S",
                           .open = open_sl1s,
                           .image = true,
                           .exposure = true}},
    SliceFormat{
        .writer = {.name = "goo",
                   .extension = ".goo",
                   .summary =
                       "a job for resin printers of Elegoo and others; as fine as the pixels of the printer",
                   .open = open_goo,
                   .more_extensions = ".prz",
                   .image = true,
                   .exposure = true},
        .recognises = is_goo,
        .read = read_goo,
        .signature = "goo (V3.0)",
        .advice = resin_job},
    SliceFormat{.writer = {.name = "ctb",
                           .extension = ".ctb",
                           .summary = "the same for printers with mainboards of Chitubox, versions 3 and 4",
                           .open = open_ctb,
                           .image = true,
                           .exposure = true},
                .recognises = is_ctb,
                .read = read_ctb,
                .signature = "ctb (86 00 FD 12)",
                .advice = resin_job},
    SliceFormat{.writer = {.name = "cbddlp",
                           .extension = ".cbddlp",
                           .summary = "the same for older ones; black and white, or grey as several images",
                           .open = open_cbddlp,
                           .more_extensions = ".photon",
                           .image = true,
                           .exposure = true},
                .recognises = is_cbddlp,
                .read = read_cbddlp,
                .signature = "cbddlp or photon (19 00 FD 12)",
                .advice = resin_job},
    SliceFormat{.writer = {.name = "anycubic",
                           .extension = ".pwmx",
                           .summary = "the same for printers of Anycubic; 16 values of grey",
                           .open = open_anycubic,
                           .more_extensions = ".pwmo .pwms .pwma .pwmb .pmsq .pm3 .pm3m .dlp",
                           .image = true,
                           .exposure = true},
                .recognises = is_anycubic,
                .read = read_anycubic,
                .signature = "Anycubic (ANYCUBIC)",
                .advice = resin_job},
    SliceFormat{.writer = {.name = "chitubox-zip",
                           .extension = "",
                           .summary = "the same as images and machine code in a zip archive",
                           .open = open_chitubox_zip,
                           .file_extension = ".zip",
                           .image = true,
                           .exposure = true},
                .in_archive = is_chitubox_zip,
                .read_archive = read_chitubox_zip},
    SliceFormat{.writer = {.name = "nanodlp",
                           .extension = ".nanodlp",
                           .summary = "the same for NanoDLP",
                           .open = open_nanodlp,
                           .image = true,
                           .exposure = true},
                .in_archive = is_nanodlp,
                .read_archive = read_nanodlp},
};

constexpr auto writers = [] {
    std::array<LayerFormat, rows.size()> formats;
    for (std::size_t i = 0; i < rows.size(); ++i)
        formats[i] = rows[i].writer;
    return formats;
}();

} // namespace

std::span<const SliceFormat> slice_formats() noexcept {
    return rows;
}

namespace {

template <class Recognises>
const SliceFormat* last_format(const Recognises& recognises) {
    const auto found = std::find_if(rows.rbegin(), rows.rend(), recognises);
    return found == rows.rend() ? nullptr : &*found;
}

} // namespace

const SliceFormat* slice_format_of(const ZipReader& archive) {
    return last_format([&](const SliceFormat& format) {
        return format.in_archive != nullptr && format.in_archive(archive);
    });
}

const SliceFormat* slice_format_of(std::string_view bytes) {
    return last_format(
        [&](const SliceFormat& format) { return format.recognises != nullptr && format.recognises(bytes); });
}

std::span<const LayerFormat> layer_formats() noexcept {
    return writers;
}

} // namespace lamella
