#pragma once

/// Marks a function as callable on the host and, when compiled by nvcc, on the device.
#ifdef __CUDACC__
#define TREACLE_HD __host__ __device__
#else
#define TREACLE_HD
#endif
