// Reads a mesh file with assimp, no steps after that but triangulation, and prints the seconds from file to
// mesh and the triangles, as JSON.

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>

#include <chrono>
#include <cstdio>
#include <string_view>

int main(int argc, char** argv) {
    if (argc != 2)
        return 2;
    if (std::string_view(argv[1]) == "--version") {
        std::printf("%u.%u.%u\n", aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch());
        return 0;
    }
    const auto start = std::chrono::steady_clock::now();
    Assimp::Importer importer;
    const aiScene* const scene = importer.ReadFile(argv[1], aiProcess_Triangulate);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (scene == nullptr) {
        std::fprintf(stderr, "%s\n", importer.GetErrorString());
        return 1;
    }
    std::size_t triangles = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i)
        triangles += scene->mMeshes[i]->mNumFaces;
    std::printf("{\"seconds\": %.9f, \"triangles\": %zu}\n", seconds.count(), triangles);
    return 0;
}
