# awk -v noise=NANOMETRES -f write_sdf.awk PATCH.csv: heights of `rugo convert`, a shortest wavelength of 4 points being 2 um,
# with white noise of this RMS, as text of ISO 25178-71 with steps of 0.1 nm.
function uniform() { seed = seed * 16807 % 2147483647; return seed / 2147483647 } # the minimal standard generator
function normal() { return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform()) }
BEGIN {
    FS = ","
    seed = 34
}
/^#/ { next }
{
    columns = NF
    for (i = 1; i <= NF; i++) text[++count] = sprintf("%.0f", ($i * 2000 + noise * normal()) / 0.1)
}
END {
    print "aISO-1.0\nManufacID = nobody\nCreateDate = 010120260000\nModDate = 010120260000"
    printf "NumPoints = %d\nNumProfiles = %d\n", columns, count / columns
    print "Xscale = 5e-7\nYscale = 5e-7\nZscale = 1e-10\nZresolution = -1\nCompression = 0\nDataType = 6\nCheckType = 0\n*"
    for (i = 1; i <= count; i++) print text[i]
    print "*"
}
