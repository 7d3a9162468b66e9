// sim/beam_kernels.hpp: the inner loops of a range cast, over plain arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace sim {

[[gnu::always_inline]] inline double cross(double ax, double ay, double bx, double by) {
  return ax * by - ay * bx;
}

/// The depth buffer of a cast: for each ray the largest 1 / range so far and, if wanted, a tag of
/// the obstacle hit. The tag is a number of the same width, so that one loop carries both.
struct DepthBuffer {
  double* inverse = nullptr;  // [1/m]
  double* tag = nullptr;      // obstacle index, -1 for none; null if not wanted
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
/// Of the two roots r of r^2 - 2 m r + k = 0 with m = c.u, the nearer has
/// 1 / r = (m + sqrt(m^2 - k)) / k, because their product is k. A beam that misses gives NaN,
/// which no comparison accepts.
void splat_circle(const double* ux,
                  const double* uy,
                  double x,
                  double y,
                  double k,
                  BeamRange beams,
                  double tag,
                  const DepthBuffer& depth);

/// Rays with their own origins: the segment from p to q, seen counter-clockwise. From o its range
/// is 1 / r = cross(p - q, u) / cross(p - o, q - o), if u lies between p and q.
void trace_segment(const RayArrays& rays,
                   double px,
                   double py,
                   double qx,
                   double qy,
                   BeamRange beams,
                   double tag,
                   const DepthBuffer& depth);

/// Rays with their own origins: a circle; from inside it 1 / r is infinite.
void trace_circle(const RayArrays& rays,
                  double x,
                  double y,
                  double radius,
                  BeamRange beams,
                  double tag,
                  const DepthBuffer& depth);

/// Converts depths to ranges. A range not nearer than `range_max` becomes exactly `range_max`.
void write_ranges(const double* inverse, double range_max, std::span<double> ranges);

/// Converts tags to obstacle indices; -1 becomes the largest index.
void write_hits(const double* tag, std::span<std::uint32_t> hits);

/// Converts a time in seconds to steps since the first step.
struct StepClock {
  double offset = 0;    // [steps]
  double per_step = 0;  // [steps/s]
  double at(double time) const { return offset + time * per_step; }
};

/// A straight piece of a sensor's motion. At step `at` in [number, number + 1) the sensor has
/// covered the fraction at - number of the way from the pose (x, y, heading).
struct MotionStep {
  double number = 0;
  double x = 0, y = 0, heading = 0;              // [m, m, rad] start
  double way_x = 0, way_y = 0, way_heading = 0;  // to the end
};
/// The sensor's poses at `times` [s], all of which lie within the piece.
void follow(const MotionStep& step,
            const StepClock& clock,
            const double* times,
            BeamRange which,
            double* x,
            double* y,
            double* heading);

/// Distributes rows to the beams: the first row holds beams 0, rows, 2 rows .., the next one beams
/// 1, rows + 1 .., and so on. `in` holds the rows end to end.
void interlace(const double* in, std::size_t beams, std::size_t rows, double* out);

/// Sets flags[i] if beams i and i + 1 hit different obstacles farther apart than `jump` [m].
void flag_edges(const double* ranges,
                const std::uint32_t* hits,
                std::size_t beams,
                double jump,
                std::uint8_t* flags);

/// Readings in the form of a scan: `nearer` with `state` 0 if below range_max, else range_max with
/// state 1 and `free_code`.
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
/// `turn` [rad] off the directions (ux, uy); accurate to 1e-8 for |turn| <= 0.5.
void turn_directions(const double* ux,
                     const double* uy,
                     const double* turn,
                     std::size_t count,
                     double* out_ux,
                     double* out_uy);

/// A scanner's conversion of true ranges [m] to readings: bias, noise times `draws`, rounding to
/// 1 / per_metre [m], limited to 0 .. `most`. A true range of range_max stays range_max, without a
/// draw.
struct Reading {
  double bias = 0, noise = 0;  // [m]
  double per_metre = 1000;
  double range_max = 0, most = 0;  // [m]
};
void read_ranges(const double* ranges, double* draws, std::size_t count, const Reading& reading);

}  // namespace sim
