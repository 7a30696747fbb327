// Cuts a mesh with CGAL's Polygon_mesh_slicer, for comparison.
//
//     cgal_slicer MESH HEIGHTS RESULT
//     cgal_slicer --version
//
// HEIGHTS has one z a line; RESULT is JSON with the seconds of reading and of slicing and, for each height,
// the number of rings and the sum of their lengths. Reading makes a surface mesh of the STL file, which the
// slicer needs; slicing includes its search tree.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/version.h>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Polyline = std::vector<Kernel::Point_3>;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool read_mesh(const std::string& path, Mesh& mesh) {
    std::vector<Kernel::Point_3> points;
    std::vector<std::array<std::size_t, 3>> triangles;
    std::ifstream file(path, std::ios::binary);
    if (!CGAL::IO::read_STL(file, points, triangles))
        return false;
    namespace processing = CGAL::Polygon_mesh_processing;
    if (!processing::is_polygon_soup_a_polygon_mesh(triangles))
        processing::orient_polygon_soup(points, triangles);
    processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    return true;
}

double length(const Polyline& line) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
        sum += std::sqrt(CGAL::to_double(CGAL::squared_distance(line[i], line[i + 1])));
    return sum;
}

int slice(const std::string& path, const std::string& heights, const std::string& result) {
    std::vector<double> planes;
    std::ifstream lines(heights);
    for (double z; lines >> z;)
        planes.push_back(z);

    auto start = Clock::now();
    Mesh mesh;
    if (!read_mesh(path, mesh)) {
        std::cerr << path << ": no STL file that CGAL reads\n";
        return 1;
    }
    const double read_seconds = seconds_since(start);

    start = Clock::now();
    CGAL::Polygon_mesh_slicer<Mesh, Kernel> slicer(mesh);
    std::vector<std::vector<Polyline>> layers(planes.size());
    for (std::size_t i = 0; i < planes.size(); ++i)
        slicer(Kernel::Plane_3(0, 0, 1, -planes[i]), std::back_inserter(layers[i]));
    const double slice_seconds = seconds_since(start);

    std::ofstream out(result);
    out << std::setprecision(17) << R"({"seconds": {"read": )" << read_seconds << R"(, "slice": )"
        << slice_seconds << "}, \"layers\": [";
    for (std::size_t i = 0; i < planes.size(); ++i) {
        double perimeter = 0;
        for (const Polyline& line : layers[i])
            perimeter += length(line);
        out << (i == 0 ? "\n" : ",\n") << R"({"z": )" << planes[i] << R"(, "contours": )" << layers[i].size()
            << R"(, "perimeter_mm": )" << perimeter << "}";
    }
    out << "]}\n";
    return out ? 0 : 1;
}

} // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string(argv[1]) == "--version") {
        std::cout << CGAL_VERSION_STR << "\n";
        return 0;
    }
    if (argc != 4) {
        std::cerr << "usage: cgal_slicer MESH HEIGHTS RESULT\n";
        return 2;
    }
    return slice(argv[1], argv[2], argv[3]);
}
