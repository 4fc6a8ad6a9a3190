// Designs from values of keys, without a text in between.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "files/toml_document.hpp"
#include "wingbeat/files/two_sides_file.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// A valid design as the document that write_design() would make of it.
Document document_of(const Design<double>& design, std::string_view name);

/// The design in a document with settings, then overrides; as parse_design.
Design<double> design_of(Document document, std::span<const Setting> settings,
                         std::span<const std::string> overrides = {}, const TableLoader& load_table = {});

/// As read_design, with settings before the overrides.
Design<double> read_design(const std::filesystem::path& file, std::span<const Setting> settings,
                           std::span<const std::string> overrides);

/// As read_vehicle, with settings before the overrides, of either side too.
VehicleFile read_vehicle(const std::filesystem::path& file, std::span<const Setting> settings,
                         std::span<const std::string> overrides);

}  // namespace wingbeat
