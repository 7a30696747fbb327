#include "parts/shuffle.hpp"

#include "parts/shapes.hpp"

namespace lamella {

TriangleSoup shuffled(const TriangleSoup& soup, std::uint64_t seed) {
    std::vector<Triangle3f> triangles(soup.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        triangles[i] = soup.stored(i);
    shuffle(std::span(triangles), seed);
    return TriangleSoup(std::move(triangles)).transformed(soup.placement());
}

} // namespace lamella
