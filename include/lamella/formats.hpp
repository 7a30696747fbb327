#pragma once

// The formats: read and write meshes and layers, show layers as pages and images. `lamella/jobs.hpp` adds the
// jobs of the program.
//
// The only global state is the list of temporary names in use (see remove_unfinished).

#include "lamella/lamella.hpp"

// Read meshes and layers.
#include "lamella/inputs/read_file.hpp"
#include "lamella/meshes/mesh_file.hpp"
#include "lamella/slices/layer_file.hpp"

// Write layers, meshes and pages; draw images.
#include "lamella/meshes/mesh_writer.hpp"
#include "lamella/raster/image.hpp"
#include "lamella/slices/layer_page.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slices/resin_fields.hpp"

// Hash files, write small files, and remove temporary files when a signal ends the program.
#include "lamella/container/file_hash.hpp"
#include "lamella/system/whole_file.hpp"
