// sim/beam_kernels.hpp: the inner loops of a cast, over plain arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sim {

[[gnu::always_inline]] inline double cross(double ax, double ay, double bx, double by) {
  return ax * by - ay * bx;
}

/// The depth buffer of a cast: for each ray the largest 1 / range met so far and, where wanted,
/// what was met. The latter as a number of the same width, so that one loop carries both.
struct DepthBuffer {
  double* inverse = nullptr;  // [1/m]
  double* tag = nullptr;      // obstacle index, -1 for none; null when not wanted
};

/// Origins and unit directions of rays.
struct RayArrays {
  const double* x = nullptr;
  const double* y = nullptr;
  const double* ux = nullptr;
  const double* uy = nullptr;
};

struct BeamRange {
  std::size_t begin = 0, end = 0;
};

/// Beams from the origin: 1 / range = a ux + b uy on a segment's line.
void splat_line(const double* ux,
                const double* uy,
                double a,
                double b,
                BeamRange beams,
                double tag,
                const DepthBuffer& depth);

/// Beams from the origin: a circle about (x, y), k its |c|^2 - R^2 > 0.
///
/// Of the two roots r of r^2 - 2 m r + k = 0 with m = c.u the nearer has 1 / r =
/// (m + sqrt(m^2 - k)) / k, because their product is k. A beam that misses gives a NaN, which no
/// comparison takes.
void splat_circle(const double* ux,
                  const double* uy,
                  double x,
                  double y,
                  double k,
                  BeamRange beams,
                  double tag,
                  const DepthBuffer& depth);

/// Rays of their own origin: the segment from p to q, seen counter-clockwise. From o its range is
/// 1 / r = cross(p - q, u) / cross(p - o, q - o), if u lies between p and q.
void trace_segment(const RayArrays& rays,
                   double px,
                   double py,
                   double qx,
                   double qy,
                   BeamRange beams,
                   double tag,
                   const DepthBuffer& depth);

/// Rays of their own origin: a circle; from inside it 1 / r is infinite.
void trace_circle(const RayArrays& rays,
                  double x,
                  double y,
                  double radius,
                  BeamRange beams,
                  double tag,
                  const DepthBuffer& depth);

/// Depths to ranges; what is not nearer than `range_max` is exactly that.
void write_ranges(const double* inverse, double range_max, std::span<double> ranges);

/// Tags to obstacle indices; -1 becomes the largest number there is.
void write_hits(const double* tag, std::span<std::uint32_t> hits);

/// When something happens in steps since the first one, from when it does in seconds.
struct StepClock {
  double offset = 0;    // [steps]
  double per_step = 0;  // [steps/s]
  double at(double time) const { return offset + time * per_step; }
};

/// A straight stretch of a sensor's motion: at step `at` in [number, number + 1) it has come from
/// the pose (x, y, heading) by that part of the way.
struct MotionStep {
  double number = 0;
  double x = 0, y = 0, heading = 0;              // [m, m, rad] at its start
  double way_x = 0, way_y = 0, way_heading = 0;  // to its end
};
/// Where the sensor is at `times` [s], all of which lie within the stretch.
void follow(const MotionStep& step,
            const StepClock& clock,
            const double* times,
            BeamRange which,
            double* x,
            double* y,
            double* heading);

/// Deals rows out to the beams: the first row has beams 0, rows, 2 rows .., the next one beams 1,
/// rows + 1 .., and so on. `in` has them end to end.
void interlace(const double* in, std::size_t beams, std::size_t rows, double* out);

/// Sets flags[i] where beams i and i + 1 met different things farther apart than `jump` [m].
void flag_edges(const double* ranges,
                const std::uint32_t* hits,
                std::size_t beams,
                double jump,
                std::uint8_t* flags);

/// Readings as a scan has them: `nearer` and its `state` 0 where below range_max, else range_max
/// and 1, with `free_code`.
struct SplitReadings {
  double* ranges = nullptr;
  std::uint8_t* state = nullptr;
  std::uint8_t* code = nullptr;
};
void split_readings(const double* readings,
                    std::size_t count,
                    double range_max,
                    std::uint8_t free_code,
                    const SplitReadings& out);

/// Rays from poses interpolated between those of a moving sensor, and turned by small angles
/// `turn` [rad] off the directions (ux, uy); of |turn| <= 0.5 good to 1e-8.
void turn_directions(const double* ux,
                     const double* uy,
                     const double* turn,
                     std::size_t count,
                     double* out_ux,
                     double* out_uy);

/// What a scanner makes of true ranges [m]: bias, noise times `draws`, rounding to
/// 1 / per_metre [m], nothing below 0 or above `most`. Where the true range is range_max, so is the
/// result, in place of the draw.
struct Reading {
  double bias = 0, noise = 0;  // [m]
  double per_metre = 1000;
  double range_max = 0, most = 0;  // [m]
};
void read_ranges(const double* ranges, double* draws, std::size_t count, const Reading& reading);

}  // namespace sim
