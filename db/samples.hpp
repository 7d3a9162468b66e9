// db/samples.hpp: the windows of samples, predicted from their neighbours, in both directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "db/block_codec.hpp"

namespace db::detail {

/// How a window was predicted.
enum class Choice : std::uint8_t { Within, Reference };

/// Appends the residuals of a window of samples to the streams.
/// @param reference an earlier window of the same size, or empty
/// @return the better way to predict it
Choice write_samples(std::span<const std::byte> samples,
                     std::span<const std::byte> reference,
                     Streams& streams);

/// Fills a window with what write_samples() wrote from the residual `at` on, which moves on.
/// @param reference as it was written; empty where that chose Choice::Within
/// Throws CodecError when the streams are too short.
void read_samples(std::span<std::byte> samples,
                  std::span<const std::byte> reference,
                  const Streams& streams,
                  std::size_t& at);

}  // namespace db::detail
