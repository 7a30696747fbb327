#pragma once

// One PNG picture for each layer and a list of them, in a folder or a zip archive.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

/// A folder with `00000.png` and so on, numbered by Layer::index, and `manifest.json`.
[[nodiscard]] std::unique_ptr<LayerWriter>
open_picture_folder(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options);

/// The same in an archive.
[[nodiscard]] std::unique_ptr<LayerWriter>
open_picture_archive(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options);

} // namespace lamella
