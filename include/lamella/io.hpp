#pragma once

// Files, formats, images and jobs, on top of the engine. This program slices a mesh file into a slice file:
//
//     #include <lamella/io.hpp>
//
//     const lamella::Plate plate = lamella::load_plate(std::array{lamella::PlateInput{.path = "part.stl"}});
//     const lamella::Box3& box = plate.box;
//     const lamella::Plan plan = lamella::plan_uniform(box.min.z, box.max.z, {.layer_height = 0.1});
//     const lamella::LayerStack layers = lamella::slice(plate, plan);
//     lamella::write_layers("part.cli", layers);
//
// The only global state is the list of temporary names in use (see remove_unfinished).

#include "lamella/lamella.hpp"

// Read meshes and layers.
#include "lamella/read/any_file.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

// Write layers, meshes and pages; draw images.
#include "lamella/raster/image.hpp"
#include "lamella/write/layer_page.hpp"
#include "lamella/write/layer_writer.hpp"
#include "lamella/write/mesh_writer.hpp"

// Whole jobs in bounded memory, by one process or many: slice or scan files, join shards, verify and compare.
#include "lamella/pipeline/compare_files.hpp"
#include "lamella/pipeline/layer_files.hpp"
#include "lamella/pipeline/layer_findings.hpp"
#include "lamella/pipeline/merge.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/scan_layers.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/pipeline/verify.hpp"

// Hash files, write small files, and remove temporary files when a signal ends the program.
#include "lamella/container/file_hash.hpp"
#include "lamella/system/whole_file.hpp"
