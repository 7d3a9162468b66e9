// db/samples.hpp: predicts windows of samples from their neighbours, for encoder and decoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "db/block_codec.hpp"

namespace db::detail {

/// How a window is predicted.
enum class Choice : std::uint8_t { Within, Reference };

/// Appends the residuals of a window of samples to the streams.
/// @param reference an earlier window of the same size, or empty
/// @return the better way to predict it
Choice write_samples(std::span<const std::byte> samples,
                     std::span<const std::byte> reference,
                     Streams& streams);

/// Fills a window from the output of write_samples(), from the residual `at` on, which advances.
/// @param reference the one given to write_samples(); empty if that chose Choice::Within
/// Throws CodecError when the streams are too short.
void read_samples(std::span<std::byte> samples,
                  std::span<const std::byte> reference,
                  const Streams& streams,
                  std::size_t& at);

}  // namespace db::detail
