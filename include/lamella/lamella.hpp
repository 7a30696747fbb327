#pragma once

// The door, in calling order. Ten lines from a mesh to a slice file:
//
//     #include <lamella/lamella.hpp>
//
//     const lamella::MeshFile part = lamella::read_mesh("part.stl");
//     const lamella::Box3 box = lamella::bounding_box(part.mesh());
//     const lamella::Plan plan = lamella::plan_uniform(box.min.z, box.max.z, {.layer_height = 0.1});
//     const lamella::LayerStack layers = lamella::slice(part.mesh(), plan);
//     lamella::write_layers("part.cli", layers);
//
// Lengths are millimetres. Failures are lamella::Error, or std::bad_alloc where memory runs out. Nothing here
// prints, exits or keeps global state, but for the temporary names in use (remove_unfinished).

// What all have in common: failures, threads and progress, texts for messages, cosines of the same bits
// everywhere, the version.
#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/unit_circle.hpp"
#include "lamella/core/version.hpp"

// A mesh: read it, or make it of arrays; inspect, repair and place it.
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/repair.hpp"
#include "lamella/mesh/self_intersections.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"

// Planes, and layers: one by one as they come, or all.
#include "lamella/contour/layer.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

// What can be asked of layers.
#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/stack_hash.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

// What can be made of layers.
#include "lamella/contour/close_gaps.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/layer_steps.hpp" // and each step by itself: fill, offset, selection, simplify

// What machines that expose them execute.
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy_fields.hpp"

// Files of layers, meshes, pictures and pages.
#include "lamella/raster/picture.hpp"
#include "lamella/read/any_file.hpp" // and of layers only, read/layer_file.hpp
#include "lamella/write/layer_page.hpp"
#include "lamella/write/layer_writer.hpp"
#include "lamella/write/mesh_writer.hpp"

// The whole way from files to a file, in bounded memory, by one process or many; the check of what came out,
// and how two files differ.
#include "lamella/pipeline/compare_files.hpp"
#include "lamella/pipeline/merge.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/pipeline/verify.hpp"

// Hashes of files, small files beside the large ones, and what is to be removed when a program is stopped by
// a signal.
#include "lamella/container/file_hash.hpp"
#include "lamella/core/whole_file.hpp"
