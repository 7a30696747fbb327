// A chess rook as if made on a lathe: a profile of lines and arcs, swept around the axis, with slots in the
// rim of its hollow crown.

#include "lamella/core/unit_circle.hpp"

#include "parts/shapes.hpp"

#include <vector>

namespace lamella {

namespace {

constexpr unsigned columns_around = 240;
constexpr unsigned merlons = 6;
constexpr unsigned merlon_columns = 24; // of the 40 columns from one merlon to the next
constexpr unsigned rim_rings = 6;
constexpr unsigned merlon_rings = 12;

constexpr double full_height = 53.15;
constexpr double base_radius = 31.75 / 2;
constexpr double crown_radius = 12.4;
constexpr double bore_radius = 9.6;
constexpr double slot_floor = 48.5;
constexpr double bore_floor = 46;

/// A point of the profile: distance from the axis, and height.
struct ProfilePoint {
    double r;
    double z;
};

using Profile = std::vector<ProfilePoint>;

/// Continues a profile by a parabolic arc (a line if the control point lies half-way).
void arc(Profile& profile, ProfilePoint control, ProfilePoint end, unsigned steps) {
    const ProfilePoint start = profile.back();
    for (unsigned i = 1; i < steps; ++i) {
        const double t = static_cast<double>(i) / steps;
        const auto at = [t](double a, double b, double c) {
            return (1 - t) * ((1 - t) * a + t * b) + t * ((1 - t) * b + t * c);
        };
        profile.push_back({at(start.r, control.r, end.r), at(start.z, control.z, end.z)});
    }
    profile.push_back(end);
}

void line(Profile& profile, ProfilePoint end, unsigned steps) {
    const ProfilePoint start = profile.back();
    arc(profile, {(start.r + end.r) / 2, (start.z + end.z) / 2}, end, steps);
}

/// Returns the profile from the edge of the base up to the floor of the slots.
Profile body_profile() {
    Profile p{{base_radius, 0}};
    line(p, {base_radius, 4}, 10);               // foot
    arc(p, {base_radius, 6}, {14.2, 6.8}, 12);   // shoulder of the foot
    line(p, {13.2, 7.6}, 3);                     //
    arc(p, {14.8, 9.2}, {12.6, 10.6}, 16);       // bead
    arc(p, {8.4, 15}, {8.2, 36}, 55);            // stem
    arc(p, {11.8, 36.4}, {11.6, 38.2}, 14);      // collar
    arc(p, {11.2, 39.4}, {8.9, 39.6}, 10);       //
    arc(p, {9.2, 42.4}, {crown_radius, 44}, 16); // flare
    line(p, {crown_radius, slot_floor}, 14);     // crown
    return p;
}

/// Returns the profile from the floor of the slots down into the bore and almost to the axis.
Profile bore_profile() {
    Profile p{{bore_radius, slot_floor}};
    line(p, {bore_radius, 46.9}, 4);
    arc(p, {bore_radius, 46.2}, {8.7, 46.1}, 6);
    line(p, {0.5, bore_floor}, 11);
    return p;
}

Profile straight(ProfilePoint from, ProfilePoint to, unsigned steps) {
    Profile p{from};
    line(p, to, steps);
    return p;
}

class Lathe {
  public:
    std::vector<Triangle3f> out;

    /// Sweeps a profile over the columns [first, last). A profile that goes up faces away from the axis.
    void sweep(const Profile& profile, unsigned first, unsigned last) {
        for (std::size_t i = 0; i + 1 < profile.size(); ++i)
            for (unsigned j = first; j < last; ++j)
                quad(at(j, profile[i]), at(j + 1, profile[i]), at(j + 1, profile[i + 1]),
                     at(j, profile[i + 1]));
    }

    /// Closes a ring of the profile with a fan about the axis at height z.
    void fan(ProfilePoint ring, double z, bool up) {
        const Point3f axis{0, 0, static_cast<float>(z)};
        for (unsigned j = 0; j < columns_around; ++j) {
            const Point3f a = at(j, ring);
            const Point3f b = at(j + 1, ring);
            out.push_back(up ? Triangle3f{a, b, axis} : Triangle3f{b, a, axis});
        }
    }

    /// Adds a radial wall at column line j, spanned by a profile upwards and one inwards. If `ahead`, it
    /// faces the columns before j.
    void radial_wall(unsigned j, const Profile& upwards, const Profile& inwards, bool ahead) {
        for (std::size_t i = 0; i + 1 < upwards.size(); ++i)
            for (std::size_t k = 0; k + 1 < inwards.size(); ++k) {
                const Point3f a = at(j, {inwards[k].r, upwards[i].z});
                const Point3f b = at(j, {inwards[k].r, upwards[i + 1].z});
                const Point3f c = at(j, {inwards[k + 1].r, upwards[i + 1].z});
                const Point3f d = at(j, {inwards[k + 1].r, upwards[i].z});
                if (ahead)
                    quad(a, b, c, d);
                else
                    quad(d, c, b, a);
            }
    }

  private:
    static Point3f at(unsigned column, ProfilePoint p) {
        static_assert(columns_around % 4 == 0, "the box is exact when there are corners on the axes");
        const CosSin turn = cos_sin_turn(column, columns_around);
        return {static_cast<float>(p.r * turn.cos), static_cast<float>(p.r * turn.sin),
                static_cast<float>(p.z)};
    }

    void quad(const Point3f& a, const Point3f& b, const Point3f& c, const Point3f& d) {
        out.push_back({a, b, c});
        out.push_back({a, c, d});
    }
};

} // namespace

TriangleSoup make_rook() {
    const Profile body = body_profile();
    const Profile bore = bore_profile();
    const Profile rise = straight({crown_radius, slot_floor}, {crown_radius, full_height}, merlon_rings);
    const Profile slot = straight({crown_radius, slot_floor}, {bore_radius, slot_floor}, rim_rings);
    Profile rim = slot;
    for (ProfilePoint& p : rim)
        p.z = full_height;
    Profile fall{rise.rbegin(), rise.rend()};
    for (ProfilePoint& p : fall)
        p.r = bore_radius;

    Lathe lathe;
    lathe.fan(body.front(), 0, false);
    lathe.sweep(body, 0, columns_around);
    for (unsigned m = 0; m < merlons; ++m) {
        const unsigned begin = m * (columns_around / merlons);
        const unsigned end = begin + merlon_columns;
        const unsigned next = begin + columns_around / merlons;
        lathe.radial_wall(begin, rise, slot, true);
        lathe.sweep(rise, begin, end);
        lathe.sweep(rim, begin, end);
        lathe.sweep(fall, begin, end);
        lathe.radial_wall(end, rise, slot, false);
        lathe.sweep(slot, end, next);
    }
    lathe.sweep(bore, 0, columns_around);
    lathe.fan(bore.back(), bore_floor, true);
    return TriangleSoup(std::move(lathe.out));
}

} // namespace lamella
