// Reads a mesh file with Lamella and prints the seconds from file to mesh and the triangles, as JSON.

#include <lamella/core/error.hpp>
#include <lamella/inputs/read_file.hpp>

#include <chrono>
#include <cstdio>
#include <iostream>

int main(int argc, char** argv) {
    if (argc != 2)
        return 2;
    try {
        const auto start = std::chrono::steady_clock::now();
        const lamella::MeshFile file = lamella::read_mesh(argv[1]);
        const lamella::Mesh mesh = file.mesh();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        std::printf("{\"seconds\": %.9f, \"triangles\": %zu}\n", seconds.count(), mesh.size());
    } catch (const lamella::Error& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
