#pragma once

// This header adds the jobs of the program to the formats; slice_file works in bounded memory, in one process
// or in many. These lines slice a small file in memory:
//
//     #include <lamella/jobs.hpp>
//
//     const lamella::Plate plate = lamella::load_plate(std::array{lamella::PlateInput{.path = "part.stl"}});
//     const lamella::Box3& box = plate.box;
//     const lamella::Plan plan = lamella::plan_uniform(box.min.z, box.max.z, {.layer_height = 0.1});
//     const lamella::LayerStack layers = lamella::slice(plate, plan);
//     lamella::write_layers("part.cli", layers);

#include "lamella/formats.hpp"

// Plates of parts; slice or scan files, join shards, verify and compare; arrays of voxels.
#include "lamella/jobs/compare_files.hpp"
#include "lamella/jobs/layer_files.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/jobs/merge.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/print_check.hpp"
#include "lamella/jobs/processes.hpp"
#include "lamella/jobs/scan_layers.hpp"
#include "lamella/jobs/slice_file.hpp"
#include "lamella/jobs/verify.hpp"
#include "lamella/jobs/voxels.hpp"
