// blackbody.c -- the colour and radiance of black bodies.
#include <tyndall/scene.h>
#include <math.h>

// Sum of a Gaussian with a width of each side; nm.
static double lobe(double x, double centre, double below, double above)
{
    const double t = (x - centre) * (x < centre ? below : above);
    return exp(-0.5 * t * t);
}

// The CIE 1931 colour matching functions, multi-lobe fits of Wyman, Sloan and Shirley 2013 (JCGT 2, 2).
static void observe(double nm, double xyz[3])
{
    xyz[0] = 1.056 * lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * lobe(nm, 442.0, 0.0624, 0.0374) -
             0.065 * lobe(nm, 501.1, 0.0490, 0.0382);
    xyz[1] = 0.821 * lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * lobe(nm, 530.9, 0.0613, 0.0322);
    xyz[2] = 1.217 * lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * lobe(nm, 459.0, 0.0385, 0.0725);
}

// Planck's law: spectral radiance, W/(m^2 sr nm).
static double planck(double nm, double kelvins)
{
    static const double first = 1.191042972e-16,
                        second = 1.438776877e-2; // 2 h c^2, W m^2; h c / k, m K
    const double m = nm * 1e-9, exponent = second / (m * kelvins);
    return exponent > 700 ? 0 : first / (m * m * m * m * m * expm1(exponent)) * 1e-9;
}

void tyn_blackbody(double kelvins, float rgb[3])
{
    enum { FIRST = 360, LAST = 830, STEP = 5 }; // nm
    static const double to_rgb[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                        {-0.9692660, 1.8760108, 0.0415560},
                                        {0.0556434, -0.2040259, 1.0572252}};
    double xyz[3] = {0};
    for (int nm = FIRST; nm <= LAST && isfinite(kelvins) && kelvins > 0; nm += STEP) {
        const double radiance = planck(nm, kelvins) * STEP;
        double seen[3];
        observe(nm, seen);
        for (int i = 0; i < 3; i++) {
            xyz[i] += seen[i] * radiance;
        }
    }
    for (int c = 0; c < 3; c++) {
        const double v = to_rgb[c][0] * xyz[0] + to_rgb[c][1] * xyz[1] + to_rgb[c][2] * xyz[2];
        rgb[c] = (float)fmin(fmax(v, 0), 1e30);
    }
}
