// An assembly of dodecahedra. Two nests are in opposite corners of the box: frames within frames, each a
// dodecahedron with a window in every face, around a solid core. Solid dodecahedra of several sizes fill the
// other corners. Bodies do not touch their neighbours because the spheres around them do not. A body does not
// touch the frame around it because its sphere fits into the hollow of that frame.

#include "lamella/core/unit_circle.hpp"

#include "parts/shapes.hpp"
#include "parts/single_precision.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr double phi = std::numbers::phi;

/// Size of a frame's hollow relative to the frame, and of its windows relative to the faces.
constexpr double hollow = 0.9;
constexpr double window = 0.62;

using Face = std::array<Point3, 5>; ///< counter-clockwise seen from outside
using Faces = std::array<Face, 12>;

double dot(const Point3& a, const Point3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

Point3 cross(const Point3& a, const Point3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Face face_along(const Point3& normal, const std::array<Point3, 20>& corners) {
    const auto is_next = [&](const Point3& a, const Point3& b) {
        // The product of neighbouring corners is sqrt(5), that of other corners of a face is 1.
        return a != b && dot(a, b) > 2 && dot(normal, cross(a, b)) > 0 && dot(normal, b) > 2;
    };
    // Along the normal, corners of the face are at phi + 1, all others below 1.
    Face face{
        *std::find_if(corners.begin(), corners.end(), [&](const Point3& p) { return dot(normal, p) > 2; })};
    for (std::size_t k = 1; k < face.size(); ++k)
        face[k] = *std::find_if(corners.begin(), corners.end(),
                                [&](const Point3& p) { return is_next(face[k - 1], p); });
    return face;
}

/// Returns the dodecahedron about the origin with corner (1, 1, 1); it spans -phi to phi along each axis.
Faces unit_dodecahedron() {
    std::array<Point3, 20> corners;
    std::array<Point3, 12> normals;
    std::size_t corner = 0;
    std::size_t normal = 0;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-1.0, 1.0}) {
            for (const Point3& p : {Point3{a, b, -1},
                                    {a, b, 1},
                                    {0, a / phi, b * phi},
                                    {a / phi, b * phi, 0},
                                    {a * phi, 0, b / phi}})
                corners[corner++] = p;
            for (const Point3& n : {Point3{a, 0, b * phi}, {a * phi, b, 0}, {0, a * phi, b}})
                normals[normal++] = n;
        }
    Faces faces;
    for (std::size_t f = 0; f < faces.size(); ++f)
        faces[f] = face_along(normals[f], corners);
    return faces;
}

struct Dodecahedron {
    Point3 centre;
    double size = 1;    ///< half the edge of the cube whose corners are among its corners
    double rotated = 0; ///< rotation about the z axis, in degrees
    double tilted = 0;  ///< then rotation about the x axis
    bool frame = false; ///< has windows and a hollow, otherwise solid
};

Point3 placed(const Point3& p, const Dodecahedron& body, double share) {
    const CosSin turn = cos_sin_degrees(body.rotated);
    const CosSin tilt = cos_sin_degrees(body.tilted);
    const double x = p.x * turn.cos - p.y * turn.sin;
    const double y = p.x * turn.sin + p.y * turn.cos;
    const double s = body.size * share;
    return {body.centre.x + s * x, body.centre.y + s * (y * tilt.cos - p.z * tilt.sin),
            body.centre.z + s * (y * tilt.sin + p.z * tilt.cos)};
}

Face placed(Face face, const Dodecahedron& body, double share) {
    for (Point3& p : face)
        p = placed(p, body, share);
    return face;
}

/// Returns the face scaled about its centroid.
Face narrowed(Face face, double share) {
    Point3 middle;
    for (const Point3& p : face)
        middle = {middle.x + p.x / 5, middle.y + p.y / 5, middle.z + p.z / 5};
    for (Point3& p : face)
        p = {middle.x + share * (p.x - middle.x), middle.y + share * (p.y - middle.y),
             middle.z + share * (p.z - middle.z)};
    return face;
}

/// Joins the edges of two faces by quads that face outwards if `outer` is the wider one.
void add_band(std::vector<Triangle3f>& out, const Face& outer, const Face& inner) {
    for (std::size_t k = 0; k < outer.size(); ++k) {
        const std::size_t next = (k + 1) % outer.size();
        out.push_back({single(outer[k]), single(outer[next]), single(inner[next])});
        out.push_back({single(outer[k]), single(inner[next]), single(inner[k])});
    }
}

void add(std::vector<Triangle3f>& out, const Dodecahedron& body, const Faces& faces) {
    for (const Face& face : faces) {
        const Face outside = placed(face, body, 1);
        if (!body.frame) {
            for (std::size_t k = 1; k + 1 < outside.size(); ++k)
                out.push_back({single(outside[0]), single(outside[k]), single(outside[k + 1])});
            continue;
        }
        const Face opening = placed(narrowed(face, window), body, 1);
        const Face inner_opening = placed(narrowed(face, window), body, hollow);
        add_band(out, outside, opening);
        add_band(out, opening, inner_opening);
        add_band(out, inner_opening, placed(face, body, hollow));
    }
}

} // namespace

TriangleSoup make_dodecahedra() {
    constexpr Point3 box{157.81, 133.62, 165.15};
    constexpr double large = 30;
    constexpr double small = 21;
    constexpr Point3 low{large * phi, large * phi, large * phi};
    constexpr Point3 high{box.x - small * phi, box.y - small * phi, box.z - small * phi};
    constexpr std::array<Dodecahedron, 13> bodies{{{.centre = low, .size = large, .frame = true},
                                                   {low, 20, 36, 20, true},
                                                   {low, 13.5, 10, 50, true},
                                                   {low, 8, 70, 15, false},
                                                   {.centre = high, .size = small, .frame = true},
                                                   {high, 14, 15, 40, true},
                                                   {high, 9, 50, 10, false},
                                                   {{127.5, 32, 30}, 16, 20, 30, false},
                                                   {{24, 116, 24}, 9, 5, 60, false},
                                                   {{34, 96, 136}, 15, 45, 15, false},
                                                   {{124, 30, 120}, 13, 80, 25, false},
                                                   {{118, 110, 55}, 12, 30, 75, false},
                                                   {{50, 32, 134}, 14, 65, 35, false}}};
    const Faces faces = unit_dodecahedron();
    std::vector<Triangle3f> out;
    for (const Dodecahedron& body : bodies)
        add(out, body, faces);
    return TriangleSoup(std::move(out));
}

} // namespace lamella
