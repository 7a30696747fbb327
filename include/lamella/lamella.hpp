#pragma once

// The door. In calling order: read, weld, inspect, plan, slice, measure, check, write or paint.
//
//     #include <lamella/lamella.hpp>
//
//     const lamella::MeshFile part = lamella::read_mesh("part.stl");
//     const lamella::Box3 box = lamella::bounding_box(part.mesh());
//     const lamella::Plan plan = lamella::plan_uniform(box.min.z, box.max.z, {.layer_height = 0.1});
//     const lamella::LayerStack layers = lamella::slice(part.mesh(), plan);
//     lamella::write_layers("part.cli", lamella::layer_format("", "part.cli"), layers,
//                           {.box = box, .layers = layers.size(), .bottom = layers.front().bottom});
//
// Lengths are millimetres. Failures are lamella::Error. Nothing here prints, exits or keeps global state,
// but for the temporary names in use (remove_unfinished).

#include "lamella/container/file_hash.hpp"
#include "lamella/container/unfinished.hpp"
#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/stack_hash.hpp"
#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/repair.hpp"
#include "lamella/mesh/self_intersections.hpp"
#include "lamella/mesh/shapes.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/pipeline/merge.hpp"
#include "lamella/pipeline/plate.hpp"
#include "lamella/pipeline/processes.hpp"
#include "lamella/pipeline/repair_policies.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/pipeline/verify.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/polygon/selection.hpp"
#include "lamella/polygon/simplify.hpp"
#include "lamella/raster/picture.hpp"
#include "lamella/read/file_kind.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"
#include "lamella/read/mesh_input.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/section_sum.hpp"
#include "lamella/slicing/slabs.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/slicing/varying_plan.hpp"
#include "lamella/write/defect_picture.hpp"
#include "lamella/write/layer_page.hpp"
#include "lamella/write/layer_writer.hpp"
#include "lamella/write/mesh_writer.hpp"
