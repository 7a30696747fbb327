#pragma once

// The engine: meshes of arrays in, layers and scan vectors out. The engine opens no file;
// `lamella/formats.hpp` does. The groups below stand in the order in which a program calls them.
//
// Lengths are millimetres. Failures are lamella::Error, or std::bad_alloc if memory runs out. Nothing here
// prints, exits or keeps global state. No result depends on the number of threads.

// Errors; threads, progress and cancellation; the version.
#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/core/suggest.hpp"
#include "lamella/core/table_value.hpp"
#include "lamella/core/unit_circle.hpp"
#include "lamella/core/version.hpp"

// Meshes: make one of arrays, inspect, repair and place it.
#include "lamella/mesh/diagnose.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/repair.hpp"
#include "lamella/mesh/self_intersections.hpp"
#include "lamella/mesh/transform.hpp"

// Slicing: plan the layers, and compute them one by one or all; sections with single planes of any direction.
#include "lamella/contour/layer.hpp"
#include "lamella/slicing/layering.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"
#include "lamella/slicing/slicer.hpp"

// Layers: measure and check them.
#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/contour/open_gaps.hpp"
#include "lamella/contour/stack_hash.hpp"
#include "lamella/polygon/cells.hpp"
#include "lamella/polygon/contour_defects.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

// Layers: change them. `layer_steps.hpp` includes fill, offset, selection and simplify.
#include "lamella/contour/close_gaps.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/layer_steps.hpp"

// Scan vectors for powder-bed machines.
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy_fields.hpp"
