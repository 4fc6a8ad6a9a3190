// What an FMU carries of its vehicle: the design as bytes, and the token by which binary and description know each
// other.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "fmu/archive.hpp"

namespace wingbeat::fmu {

inline constexpr const char* vehicle_resource = "vehicle.bin";
inline constexpr const char* resource_head = "wingbeat FMU vehicle 1\n";

inline std::string resource_of(const Design<double>& design) {
  ArchiveWriter out;
  out(design);
  return resource_head + out.bytes;
}

/// Throws std::runtime_error for what is no such resource.
inline Design<double> design_of(const std::string& resource) {
  const std::string head = resource_head;
  if (resource.compare(0, head.size(), head) != 0) throw std::runtime_error("vehicle.bin is not a vehicle");
  ArchiveReader in(std::string_view(resource).substr(head.size()));
  Design<double> design;
  in(design);
  return design;
}

/// A check sum (two of FNV's 64 bits), written as a GUID.
inline std::string token_of(const std::string& resource) {
  std::uint64_t sums[2] = {14695981039346656037ull, 1099511628211ull};
  for (const unsigned char c : resource) {
    for (std::uint64_t& sum : sums) sum = (sum ^ c) * 1099511628211ull;
    sums[1] ^= sums[0] >> 29;
  }
  char text[48];
  std::snprintf(text, sizeof text, "{%08x-%04x-%04x-%04x-%012llx}", unsigned(sums[0] >> 32),
                unsigned(sums[0] >> 16 & 0xffff), unsigned(sums[0] & 0xffff), unsigned(sums[1] >> 48),
                static_cast<unsigned long long>(sums[1] & 0xffffffffffffull));
  return text;
}

}  // namespace wingbeat::fmu
