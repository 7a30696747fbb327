#pragma once

// The formats of slice files. Each has a source. docs/formats.md describes their content.

#include "lamella/slices/layer_writer.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lamella {

using OpenLayerWriter = std::unique_ptr<LayerWriter>(const std::string& path, const LayerFileInfo& info,
                                                     const LayerWriteOptions& options);

/// Common Layer Interface 2.0.
OpenLayerWriter open_common_layer_ascii;
OpenLayerWriter open_common_layer_binary;
/// DXF of AutoCAD Release 12, as text.
OpenLayerWriter open_dxf;
/// GeoJSON (RFC 7946), in millimetres.
OpenLayerWriter open_geojson;
/// ILT: Common Layer Interface files in a zip archive, with the parameters of each. There is no published
/// description; docs/formats.md describes what files of several programs have in common.
OpenLayerWriter open_ilt;
/// SVG: one file with all layers, as Slic3r writes it.
OpenLayerWriter open_layered_svg;
/// A folder with `layer_00000.svg` and so on, numbered by Layer::index.
OpenLayerWriter open_svg_layers;
/// All data of layers, as JSON.
OpenLayerWriter open_layers_json;
/// Raw arrays of one layer after the other, for programs that read them from a pipe.
OpenLayerWriter open_raw;
/// NumPy arrays in a zip archive, as numpy.load reads them.
OpenLayerWriter open_npz;
/// Open Vector Format, of Digital Production Aachen: messages of Protocol Buffers, with tables of their
/// offsets.
OpenLayerWriter open_ovf;
/// A folder with a PNG image for each layer, `00000.png` and so on, numbered by Layer::index, and
/// `manifest.json`.
OpenLayerWriter open_image_folder;
/// The content of such a folder in a zip archive.
OpenLayerWriter open_image_archive;
/// The print jobs of Original Prusa SL1 and SL1S.
OpenLayerWriter open_sl1;
OpenLayerWriter open_sl1s;
/// Elegoo's .goo, version 3.0 ("Goo Format Spec V1.2").
OpenLayerWriter open_goo;
/// Chitubox's .ctb, versions 3 and 4, not encrypted; .cbddlp and .photon, version 2; and its zip archives.
/// There is no published specification; docs/formats.md describes what files and programs have in common.
OpenLayerWriter open_ctb;
OpenLayerWriter open_cbddlp;
OpenLayerWriter open_chitubox_zip;
/// Anycubic's container of Photon Workshop, versions 515 and 516; as for .ctb.
OpenLayerWriter open_anycubic;
/// The plates of NanoDLP; as for .ctb.
OpenLayerWriter open_nanodlp;
/// SLC 2.0 of 3D Systems, binary.
OpenLayerWriter open_slc;
/// 3MF with slice stacks (3MF Slice Extension).
OpenLayerWriter open_slices_3mf;
/// 3MF with toolpaths (3MF Toolpath Extension 1.0, a release candidate).
OpenLayerWriter open_toolpath_3mf;

} // namespace lamella
