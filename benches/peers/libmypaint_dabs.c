/* Peer of benches/brush.rs: libmypaint's flat round dabs on its own tiles, one thread.
 *
 * usage: libmypaint_dabs RADIUS...
 * Prints one number a radius: ns per covered pixel (pi r^2), the best of the strokes, which other programs disturbed least.
 * A stroke is DABS dabs 14 px apart (of small radii a fifth of the radius) along a circle of 700 px on a 2048 px
 * surface, drawn and processed as one atomic operation, as the bench's strokes are.
 */
#include <libmypaint/mypaint-brush.h>
#include <libmypaint/mypaint-fixed-tiled-surface.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { DABS = 128, STROKES = 15 };

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double stroke(MyPaintSurface *surface, float radius) {
    MyPaintRectangle changed;
    const double start = seconds();
    mypaint_surface_begin_atomic(surface);
    for (int i = 0; i < DABS; i++) {
        const float step = radius < 32 ? 0.2f * radius : 14.0f;
        const float angle = step / 700.0f * (float)i;
        const float x = 1024 + 700 * cosf(angle), y = 1024 + 700 * sinf(angle);
        mypaint_surface_draw_dab(surface, x, y, radius, 0.9f, 0.5f, 0.1f, 0.4f, 0.5f, 1, 1, 0, 0, 0);
    }
    mypaint_surface_end_atomic(surface, &changed);
    return seconds() - start;
}

int main(int count, char **radii) {
    for (int i = 1; i < count; i++) {
        const float radius = (float)atof(radii[i]);
        MyPaintFixedTiledSurface *tiles = mypaint_fixed_tiled_surface_new(2048, 2048);
        MyPaintSurface *surface = (MyPaintSurface *)tiles;
        double best = stroke(surface, radius); /* touches the memory */
        for (int k = 0; k < STROKES; k++)
            best = fmin(best, stroke(surface, radius));
        printf("%.3f\n", 1e9 * best / (DABS * 3.14159265 * radius * radius));
        mypaint_surface_unref(surface);
    }
    return 0;
}
