/* A program in C that uses each function of the interface, in the given folder. */
#include <lamella/c/lamella.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void expect(int holds, const char *what) {
    if (holds)
        return;
    fprintf(stderr, "%s does not hold; the last error is: %s\n", what, lamella_error());
    exit(1);
}
#define EXPECT(condition) expect(condition, #condition)

static int count(void *user, const char *stage, uint64_t done, uint64_t total) {
    int *calls = user;
    ++*calls;
    return strlen(stage) == 0 || done > total;
}

static int stop(void *user, const char *stage, uint64_t done, uint64_t total) {
    (void)user, (void)stage, (void)done, (void)total;
    return 1;
}

static void one_after_the_other(void *user, uint32_t tasks, void (*task)(void *data, uint32_t number), void *data) {
    int *calls = user;
    for (uint32_t i = tasks; i > 0; --i)
        task(data, i - 1);
    *calls += 1000;
}

int main(int argc, char **argv) {
    static const double vertices[] = {0, 0, 0, 8, 0, 0, 8, 8, 0, 0, 8, 0, 4, 4, 4};
    static const uint32_t triangles[] = {0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    static const double heights[] = {1, 2, 3};
    static const double moved[] = {1, 0, 0, 10, 0, 1, 0, 0, 0, 0, 1, 0};
    static const double origin[] = {4, 4, 1}, normal[] = {1, 0, 0};
    static const double square[] = {1, 1, 7, 1, 7, 7, 1, 7, 3, 3, 3, 5, 5, 5, 5, 3};
    static const uint64_t offsets[] = {0, 4, 8};
    double box[6], to_mesh[12];
    int64_t parents[2];
    uint64_t closed = 7;
    char path[4096];
    int calls = 0;
    lamella_mesh *pyramid = NULL, *shifted = NULL, *missing = NULL;
    lamella_mesh *mended = NULL;
    lamella_layers *layers = NULL, *again = NULL, *section = NULL, *made = NULL, *grown = NULL, *both = NULL;
    lamella_slicer *slicer = NULL;
    lamella_bytes *bytes = NULL;
    lamella_layer layer = {.size = sizeof layer}, frame = {.size = sizeof frame};
    lamella_settings settings = {.size = sizeof settings};
    lamella_plan plan = {.size = sizeof plan};
    lamella_mending mending = {.size = sizeof mending};
    lamella_mended counts = {.size = sizeof counts};
    lamella_corners corners = {.size = sizeof corners};

    EXPECT(argc == 2);
    EXPECT(lamella_abi() == LAMELLA_ABI);
    EXPECT(strlen(lamella_version()) > 0);

    EXPECT(lamella_make_mesh(vertices, 5, triangles, 6, &pyramid) == LAMELLA_OK);
    EXPECT(lamella_triangle_count(pyramid) == 6);
    EXPECT(lamella_transform_mesh(pyramid, moved, &shifted) == LAMELLA_OK);
    EXPECT(lamella_mesh_box(shifted, box) == LAMELLA_OK);
    EXPECT(box[0] == 10 && box[3] == 18 && box[2] == 0 && box[5] == 4);

    settings.threads = 2;
    settings.progress = count;
    settings.user = &calls;
    EXPECT(lamella_slice(pyramid, 2, &settings, &layers) == LAMELLA_OK);
    EXPECT(calls > 0 && lamella_layer_count(layers) == 2);
    EXPECT(lamella_get_layer(layers, 1, &layer) == LAMELLA_OK);
    EXPECT(layer.z == 3 && layer.contour_count == 1 && layer.rings == 1 && layer.point_count == 4);
    EXPECT(layer.points[0] == 3 && layer.points[1] == 3 && layer.offsets[1] == 4);
    EXPECT(fabs(layer.area_mm2 - 4) < 1e-12);

    snprintf(path, sizeof path, "%s/from_c.cli", argv[1]);
    EXPECT(lamella_write_layers(layers, path, NULL, NULL) == LAMELLA_OK);
    EXPECT(lamella_read_layers(path, NULL, &again) == LAMELLA_OK);
    EXPECT(lamella_layer_count(again) == 2 && strlen(lamella_warnings()) == 0);
    lamella_free_layers(again);
    lamella_free_layers(layers);

    settings.progress = stop;
    EXPECT(lamella_slice_at(pyramid, heights, 3, &settings, &layers) == LAMELLA_CANCELLED);
    settings.progress = NULL;
    settings.run_tasks = one_after_the_other;
    EXPECT(lamella_slice_at(shifted, heights, 3, &settings, &layers) == LAMELLA_OK);
    EXPECT(lamella_layer_count(layers) == 3);
    lamella_free_layers(layers);

    plan.layer_height = 1;
    plan.first_layer_height = 2;
    plan.cut = LAMELLA_CUT_TOP;
    EXPECT(lamella_slice_by_plan(pyramid, &plan, NULL, &layers) == LAMELLA_OK);
    EXPECT(lamella_layer_count(layers) == 3);
    EXPECT(lamella_get_layer(layers, 0, &layer) == LAMELLA_OK && layer.z == 2 && layer.bottom == 0);
    EXPECT(lamella_write_layers_bytes(layers, "json", NULL, &bytes) == LAMELLA_OK);
    EXPECT(lamella_bytes_size(bytes) > 0 && lamella_bytes_data(bytes) != NULL);
    EXPECT(lamella_read_layers_bytes(lamella_bytes_data(bytes), lamella_bytes_size(bytes), "bytes", NULL, &again) ==
           LAMELLA_OK);
    EXPECT(lamella_layer_count(again) == 3);
    lamella_free_bytes(bytes);
    lamella_free_layers(again);
    lamella_free_layers(layers);

    mending.orient = 1;
    EXPECT(lamella_mend(pyramid, &mending, NULL, &counts, &mended) == LAMELLA_OK);
    EXPECT(counts.flipped_triangles == 0 && lamella_triangle_count(mended) == 6);
    lamella_free_mesh(mended);

    frame.top = 1;
    frame.points = square;
    frame.point_count = 8;
    frame.offsets = offsets;
    frame.contour_count = frame.rings = 2;
    EXPECT(lamella_make_layer(&frame, &made) == LAMELLA_OK);
    EXPECT(lamella_ring_parents(made, 0, parents) == LAMELLA_OK && parents[0] == -1 && parents[1] == 0);
    corners.join = LAMELLA_BEVEL;
    EXPECT(lamella_offset(made, 1, &corners, NULL, &grown) == LAMELLA_OK);
    EXPECT(lamella_get_layer(grown, 0, &layer) == LAMELLA_OK && layer.rings == 1 && fabs(layer.area_mm2 - 62) < 1e-9);
    EXPECT(lamella_combine(made, grown, LAMELLA_UNION, NULL, &both) == LAMELLA_OK);
    EXPECT(lamella_get_layer(both, 0, &layer) == LAMELLA_OK && fabs(layer.area_mm2 - 62) < 1e-9);
    EXPECT(lamella_close_gaps(made, 0.1, NULL, &closed, &again) == LAMELLA_OK && closed == 0);
    lamella_free_layers(again);
    lamella_free_layers(both);
    lamella_free_layers(grown);
    lamella_free_layers(made);

    EXPECT(lamella_prepare(pyramid, LAMELLA_SECTION_ABOVE, NULL, &slicer) == LAMELLA_OK);
    lamella_free_mesh(pyramid); /* the slicer does not need it */
    EXPECT(lamella_section(slicer, 3, &section) == LAMELLA_OK);
    EXPECT(lamella_get_layer(section, 0, &layer) == LAMELLA_OK && layer.points[0] == 3);
    lamella_free_layers(section);
    EXPECT(lamella_section_of_plane(slicer, origin, normal, to_mesh, &section) == LAMELLA_OK);
    EXPECT(lamella_get_layer(section, 0, &layer) == LAMELLA_OK && fabs(layer.area_mm2 - 16) < 1e-9);
    EXPECT(to_mesh[3] == 4 && to_mesh[7] == 4 && to_mesh[11] == 1);
    lamella_free_layers(section);

    EXPECT(lamella_read_mesh("no such file.stl", NULL, &missing) == LAMELLA_INPUT && missing == NULL);
    EXPECT(strstr(lamella_error(), "no such file.stl") != NULL);
    EXPECT(lamella_read_mesh_bytes("solid", 5, "bytes", NULL, &missing) == LAMELLA_INPUT);
    EXPECT(lamella_make_mesh(vertices, 2, triangles, 6, &missing) != LAMELLA_OK && missing == NULL);

    lamella_free_slicer(slicer);
    lamella_free_mesh(shifted);
    lamella_free_mesh(NULL);
    lamella_free_layers(NULL);
    lamella_free_bytes(NULL);
    lamella_free_slicer(NULL);
    return 0;
}
