#pragma once

namespace treacle {

struct OutputFields {
  bool velocity = true, pressure = true, numberDensity = true, nearestDistance = true, material = true,
       body = true, id = true;
  bool dynamicViscosity = true, shearRate = true;  // in cases where a material has a rheology
  bool temperature = true;                         // in cases with heat
  bool viscosityFactor = true;                     // in cases where a body gives one

  bool operator==(const OutputFields&) const = default;
};

enum class OutputFormat { Vtp };  // the only one
enum class OutputPrecision { Single, Double };
/// Of frames; zlib's as VTK has it.
enum class OutputCompression { Zlib, None };
/// Who writes frames where processes share a run: the first one all particles, or each its own.
enum class OutputPieces { Auto, One, Each };

struct OutputSettings {
  double interval = 0;            // between frames [s]; 0: first and last frame only
  double checkpointInterval = 0;  // between checkpoints [s]; 0: at the end of the run only
  OutputFields fields;
  OutputPrecision precision = OutputPrecision::Single;
  OutputCompression compression = OutputCompression::Zlib;
  OutputPieces pieces = OutputPieces::Auto;
  bool surface = false;  // of each frame, as triangles, beside it; three dimensions only
  bool balance = false;  // energy balance and loads on walls of each step; MPH-I only

  bool operator==(const OutputSettings&) const = default;
};

/// Beyond which a run ends, because it no longer means anything; 0: is not looked at. step/watch.hpp says what is
/// measured. Warnings come earlier.
struct WatchSettings {
  double energy = 1;          // rise of the mechanical energy over what start and gravity have given
  double courant = 10;        // distance of the fastest particle in a step, in spacings
  double insideWalls = 0.05;  // share of fluid particles inside walls
  double density = 0.25;      // mean excess of the density over that of the material

  bool operator==(const WatchSettings&) const = default;
};

}  // namespace treacle
