#include "core/instrument/foreign.h"
#include <string.h>

/* Marks as the modules of Gwyddion 2.62 and file(1) 5.44 have them; a longer one stands before its
 * beginning. */
#define MARK(text) text, sizeof(text) - 1
static const struct foreign_format FORMATS[] = {
    {MARK("AliconaImaging"), "Alicona's AL3D", false},
    {MARK("\x01\x00"
          "Directory"),
     "Wyko's OPD", false},
    {MARK("VCA DATA"), "Bruker's OPDx", false},
    {MARK("DIGITAL SURF"), "Digital Surf's SUR", false},
    {MARK("DSCOMPRESSED"), "Digital Surf's compressed SUR", false},
    {MARK("\x88\x1b\x03\x6f"), "Zygo's MetroPro", false},
    {MARK("\x88\x1b\x03\x70"), "Zygo's MetroPro", false},
    {MARK("\x88\x1b\x03\x71"), "Zygo's MetroPro", false},
    {MARK("\\*File list"), "Nanoscope", false},
    {MARK("\\*EC File list"), "Nanoscope", false},
    {MARK("\\*Force file list"), "Nanoscope", false},
    {MARK("FRTM_GLIDER"), "FRT's MicroProf", false},
    {MARK("\x05\x00"), "Igor's binary wave", false},
    {MARK("\x00\x05"), "Igor's binary wave", false},
    {MARK("fileType      "), "Molecular Imaging's MI", false},
    {MARK("WSxM file copyright"), "WSxM", false},
    {MARK("fileformat"), "BCR", false},
    {MARK("f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0"), "BCR in UTF-16", false},
    {MARK("[DataSet]"), "Nanosurf's NID", false},
    {MARK("Binary TrueMap"), "TrueMap", false},
    {MARK("VK4_"), "Keyence's VK4", false},
    {MARK("VK6"), "Keyence's VK6", false},
    {MARK("VK7"), "Keyence's VK7", false},
    {MARK("KPK0"), "Keyence's ZON", false},
    {MARK(":NANONIS_VERSION:"), "Nanonis' SXM", false},
    {MARK("STiMage"), "RHK's SM3", false},
    {MARK("DSBB"), "Surfer's binary grid", false},
    {MARK("DSRB"), "Surfer's binary grid", false},
    {MARK("\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"), "a compound document, as Mountains writes", false},
    {MARK("\x89HDF\r\n\x1a\n"), "HDF5, as Zygo's DATX", false},
    {MARK("CDF\x01"), "NetCDF", false},
    {MARK("CDF\x02"), "NetCDF", false},
    {MARK("MATLAB 5.0"), "Matlab's MAT", false},
    {MARK("II*\0"), "TIFF, as microscopes write", false},
    {MARK("MM\0*"), "TIFF, as microscopes write", false},
    {MARK("\x89PNG"), "PNG", true},
    {MARK("\xff\xd8\xff"), "JPEG", true},
    {MARK("GIF8"), "GIF", true},
    {MARK("%PDF"), "PDF", true},
};

const struct foreign_format *foreign_format_of(const char *data, size_t size) {
    for (size_t f = 0; f < sizeof FORMATS / sizeof *FORMATS; f++)
        if (size > FORMATS[f].length && memcmp(data, FORMATS[f].mark, FORMATS[f].length) == 0)
            return &FORMATS[f];
    return NULL;
}
