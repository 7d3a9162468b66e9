// sim/beam_kernels.cpp: simple loops without branches, which g++ 12 vectorises at -O3.
#include "sim/beam_kernels.hpp"

#include <cmath>
#include <limits>

#include "algo/wide.hpp"

namespace sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Takes `value(i)` if it is nearer than the stored value. Never takes NaN.
template <typename Value>
[[gnu::always_inline]] inline void take_nearer(const DepthBuffer& depth,
                                               double tag,
                                               BeamRange beams,
                                               Value value) {
  double* __restrict inverse = depth.inverse;
  double* __restrict tags = depth.tag;
  if (tags == nullptr) {
    for (std::size_t i = beams.begin; i < beams.end; ++i) {
      const double candidate = value(i);
      inverse[i] = candidate > inverse[i] ? candidate : inverse[i];
    }
    return;
  }
  for (std::size_t i = beams.begin; i < beams.end; ++i) {
    const double candidate = value(i);
    const double before = inverse[i];
    inverse[i] = candidate > before ? candidate : before;
    tags[i] = candidate > before ? tag : tags[i];
  }
}

}  // namespace

TAUTLINE_WIDE void splat_line(const double* ux,
                              const double* uy,
                              double a,
                              double b,
                              BeamRange beams,
                              double tag,
                              const DepthBuffer& depth) {
  take_nearer(
      depth, tag, beams, [=](std::size_t i) __attribute__((always_inline)) {
        return a * ux[i] + b * uy[i];
      });
}

TAUTLINE_WIDE void splat_circle(const double* ux,
                                const double* uy,
                                double x,
                                double y,
                                double k,
                                BeamRange beams,
                                double tag,
                                const DepthBuffer& depth) {
  const double inverse_k = 1 / k;
  take_nearer(
      depth, tag, beams, [=](std::size_t i) __attribute__((always_inline)) {
        const double m = x * ux[i] + y * uy[i];
        return (m + std::sqrt(m * m - k)) * inverse_k;
      });
}

TAUTLINE_WIDE void trace_segment(const RayArrays& rays,
                                 double px,
                                 double py,
                                 double qx,
                                 double qy,
                                 BeamRange beams,
                                 double tag,
                                 const DepthBuffer& depth) {
  const double* x = rays.x;
  const double* y = rays.y;
  const double* ux = rays.ux;
  const double* uy = rays.uy;
  take_nearer(
      depth, tag, beams, [=](std::size_t i) __attribute__((always_inline)) {
        const double pxi = px - x[i];
        const double pyi = py - y[i];
        const double qxi = qx - x[i];
        const double qyi = qy - y[i];
        const double left_of_p = cross(pxi, pyi, ux[i], uy[i]);
        const double left_of_q = cross(qxi, qyi, ux[i], uy[i]);
        const double area = cross(pxi, pyi, qxi, qyi);
        const double inverse = (left_of_p - left_of_q) / area;
        const double between = left_of_p >= 0 ? inverse : 0;
        const double in_front = left_of_q < 0 ? between : 0;
        return area > 0 ? in_front : 0;
      });
}

TAUTLINE_WIDE void trace_circle(const RayArrays& rays,
                                double x,
                                double y,
                                double radius,
                                BeamRange beams,
                                double tag,
                                const DepthBuffer& depth) {
  const double* ox = rays.x;
  const double* oy = rays.y;
  const double* ux = rays.ux;
  const double* uy = rays.uy;
  const double square = radius * radius;
  const double inside = kInfinity;
  take_nearer(
      depth, tag, beams, [=](std::size_t i) __attribute__((always_inline)) {
        const double cx = x - ox[i];
        const double cy = y - oy[i];
        const double m = cx * ux[i] + cy * uy[i];
        const double k = cx * cx + cy * cy - square;
        const double inverse = (m + std::sqrt(m * m - k)) / k;
        return k > 0 ? inverse : inside;
      });
}

TAUTLINE_WIDE void write_ranges(const double* inverse, double range_max, std::span<double> ranges) {
  const double nothing = 1 / range_max;
  double* __restrict out = ranges.data();
  const std::size_t count = ranges.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double range = 1 / inverse[i];
    out[i] = inverse[i] > nothing ? range : range_max;
  }
}

TAUTLINE_WIDE void write_hits(const double* tag, std::span<std::uint32_t> hits) {
  std::uint32_t* __restrict out = hits.data();
  const std::size_t count = hits.size();
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(tag[i]));
  }
}

TAUTLINE_WIDE void follow(const MotionStep& step,
                          const StepClock& clock,
                          const double* times,
                          BeamRange which,
                          double* x,
                          double* y,
                          double* heading) {
  const MotionStep s = step;
  const StepClock when = clock;
  double* __restrict out_x = x;
  double* __restrict out_y = y;
  double* __restrict out_heading = heading;
  for (std::size_t i = which.begin; i < which.end; ++i) {
    const double part = when.offset + times[i] * when.per_step - s.number;
    out_x[i] = s.x + part * s.way_x;
    out_y[i] = s.y + part * s.way_y;
    out_heading[i] = s.heading + part * s.way_heading;
  }
}

TAUTLINE_WIDE void interlace(const double* in, std::size_t beams, std::size_t rows, double* out) {
  double* __restrict to = out;
  if (rows == 2) {  // the usual mode, written to vectorise
    const double* odd = in + (beams + 1) / 2;
    for (std::size_t i = 0; i < beams / 2; ++i) {
      to[2 * i] = in[i];
      to[2 * i + 1] = odd[i];
    }
    if (beams % 2 == 1) to[beams - 1] = in[beams / 2];
    return;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = row; i < beams; i += rows) to[i] = *in++;
  }
}

TAUTLINE_WIDE void flag_edges(const double* ranges,
                              const std::uint32_t* hits,
                              std::size_t beams,
                              double jump,
                              std::uint8_t* flags) {
  std::uint8_t* __restrict out = flags;
  for (std::size_t i = 0; i + 1 < beams; ++i) {
    const double step = std::abs(ranges[i] - ranges[i + 1]);
    const unsigned far = step > jump ? 1 : 0;
    const unsigned other = hits[i] != hits[i + 1] ? 1 : 0;
    out[i] = static_cast<std::uint8_t>(far & other);
  }
}

TAUTLINE_WIDE void split_readings(const double* readings,
                                  std::size_t count,
                                  double range_max,
                                  std::uint8_t free_code,
                                  const SplitReadings& out) {
  double* __restrict ranges = out.ranges;
  std::uint8_t* __restrict state = out.state;
  std::uint8_t* __restrict code = out.code;
  for (std::size_t i = 0; i < count; ++i) {
    ranges[i] = readings[i] < range_max ? readings[i] : range_max;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool free = !(readings[i] < range_max);
    state[i] = free ? 1 : 0;
    code[i] = free ? free_code : std::uint8_t{0};
  }
}

TAUTLINE_WIDE void turn_directions(const double* ux,
                                   const double* uy,
                                   const double* turn,
                                   std::size_t count,
                                   double* out_ux,
                                   double* out_uy) {
  double* __restrict x = out_ux;
  double* __restrict y = out_uy;
  for (std::size_t i = 0; i < count; ++i) {
    // The series of sine and cosine; the first omitted terms are t^9 / 9! and t^8 / 8!.
    const double t = turn[i];
    const double t2 = t * t;
    const double sine = t * (1 - t2 * (1.0 / 6) * (1 - t2 * (1.0 / 20) * (1 - t2 * (1.0 / 42))));
    const double cosine = 1 - t2 * 0.5 * (1 - t2 * (1.0 / 12) * (1 - t2 * (1.0 / 30)));
    x[i] = cosine * ux[i] - sine * uy[i];
    y[i] = sine * ux[i] + cosine * uy[i];
  }
}

TAUTLINE_WIDE void read_ranges(const double* ranges,
                               double* draws,
                               std::size_t count,
                               const Reading& reading) {
  // Adding this number leaves no bits for a fraction: it rounds to the nearest, halves to even.
  // Unlike nearbyint(), it vectorises on every x86-64.
  constexpr double kNoFraction = 0x1.8p52;
  const Reading r = reading;
  double* __restrict out = draws;
  for (std::size_t i = 0; i < count; ++i) {
    const double noisy = ranges[i] + r.bias + r.noise * out[i];
    const double positive = noisy > 0 ? noisy : 0;
    const double clipped = positive < r.most ? positive : r.most;
    const double value = ((clipped * r.per_metre + kNoFraction) - kNoFraction) / r.per_metre;
    out[i] = ranges[i] < r.range_max ? value : r.range_max;
  }
}

}  // namespace sim
