#pragma once

#include "lamella/jobs/file_result.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

namespace lamella::test {

inline void expect_same(const LayerChanges& one, const LayerChanges& other) {
    for (std::uint64_t LayerChanges::*count :
         {&LayerChanges::changed_layers, &LayerChanges::groups_united, &LayerChanges::rings_united,
          &LayerChanges::rings_reversed, &LayerChanges::rings_dropped, &LayerChanges::rings_vanished,
          &LayerChanges::points_dropped})
        EXPECT_EQ(one.*count, other.*count);
    EXPECT_EQ(one.area_before_mm2, other.area_before_mm2);
    EXPECT_EQ(one.area_after_mm2, other.area_after_mm2);
}

inline void expect_same(const ScanFigures& one, const ScanFigures& other) {
    EXPECT_EQ(one.vectors, other.vectors);
    for (double ScanFigures::*figure : {&ScanFigures::marked_mm, &ScanFigures::jumped_mm,
                                        &ScanFigures::build_seconds, &ScanFigures::energy_j})
        EXPECT_EQ(one.*figure, other.*figure);
}

inline void expect_same(const LayerStatistics& one, const LayerStatistics& other) {
    EXPECT_EQ(one.index, other.index);
    EXPECT_EQ(one.z, other.z);
    EXPECT_EQ(one.thickness, other.thickness);
    EXPECT_EQ(one.hash, other.hash);
    for (std::size_t LayerMeasure::*count :
         {&LayerMeasure::contours, &LayerMeasure::holes, &LayerMeasure::open_chains, &LayerMeasure::points})
        EXPECT_EQ(one.measure.*count, other.measure.*count);
    EXPECT_EQ(one.measure.area_mm2, other.measure.area_mm2);
    EXPECT_EQ(one.measure.perimeter_mm, other.measure.perimeter_mm);
    EXPECT_EQ(one.findings, other.findings);
    expect_same(one.changes, other.changes);
    ASSERT_EQ(one.scan.size(), other.scan.size());
    for (std::size_t i = 0; i < one.scan.size(); ++i)
        expect_same(one.scan[i], other.scan[i]);
    ASSERT_EQ(one.joins.size(), other.joins.size());
    for (std::size_t i = 0; i < one.joins.size(); ++i) {
        EXPECT_EQ(one.joins[i].from, other.joins[i].from);
        EXPECT_EQ(one.joins[i].to, other.joins[i].to);
        EXPECT_EQ(one.joins[i].length_mm, other.joins[i].length_mm);
    }
}

/// Expects equal figures of mesh, layers and output, bit for bit, except for times and the distribution of
/// work.
inline void expect_same(const FileResult& one, const FileResult& other) {
    EXPECT_EQ(one.triangles, other.triangles);
    EXPECT_EQ(one.box, other.box);
    EXPECT_EQ(one.mesh_volume_mm3, other.mesh_volume_mm3);
    EXPECT_EQ(one.volume_mm3, other.volume_mm3);
    EXPECT_EQ(one.planned_layers, other.planned_layers);
    EXPECT_EQ(one.bottom, other.bottom);
    EXPECT_EQ(one.top, other.top);
    EXPECT_EQ(one.bytes, other.bytes);
    EXPECT_EQ(one.losses.by_file, other.losses.by_file);
    for (std::uint64_t SliceReport::*count :
         {&SliceReport::layers, &SliceReport::contours, &SliceReport::open_chains, &SliceReport::points})
        EXPECT_EQ(one.report.*count, other.report.*count);
    EXPECT_EQ(one.findings.texts(), other.findings.texts());
    EXPECT_EQ(one.findings.by_file, other.findings.by_file);
    EXPECT_EQ(one.findings.total, other.findings.total);
    EXPECT_EQ(one.gaps.closed, other.gaps.closed);
    EXPECT_EQ(one.gaps.longest_mm, other.gaps.longest_mm);
    EXPECT_EQ(one.gaps.total_mm, other.gaps.total_mm);
    EXPECT_EQ(one.gaps.layers, other.gaps.layers);
    EXPECT_EQ(one.gaps.first_z, other.gaps.first_z);
    EXPECT_EQ(one.changes.has_value(), other.changes.has_value());
    if (one.changes && other.changes)
        expect_same(*one.changes, *other.changes);
    ASSERT_EQ(one.layers.size(), other.layers.size());
    for (std::size_t i = 0; i < one.layers.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "layer " << i);
        expect_same(one.layers[i], other.layers[i]);
    }
    ASSERT_EQ(one.exposures.size(), other.exposures.size());
    for (std::size_t i = 0; i < one.exposures.size(); ++i)
        expect_same(one.exposures[i].figures, other.exposures[i].figures);
    ASSERT_EQ(one.parts.size(), other.parts.size());
    for (std::size_t i = 0; i < one.parts.size(); ++i) {
        EXPECT_EQ(one.parts[i].label, other.parts[i].label);
        EXPECT_EQ(one.parts[i].box, other.parts[i].box);
        for (std::uint64_t PartResult::*count :
             {&PartResult::triangles, &PartResult::contours, &PartResult::open_chains, &PartResult::points})
            EXPECT_EQ(one.parts[i].*count, other.parts[i].*count);
    }
}

} // namespace lamella::test
