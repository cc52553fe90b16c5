// write_patch.js WHOLE.npy PATCH.x3p: a corner of 256 x 256 points of the map that `rugo generate recipe.json` gives, as an
// instrument would have measured it: steps of 0.1 nm, 0.5 um apart, a shortest wavelength being 2 um. x3p.js packs it.
//     npm install x3p.js@0.10.4 jsdom@22.1.0 jszip@3.10.1
const { JSDOM } = require("jsdom");
const { createHash } = require("crypto");
const { readFileSync, writeFileSync } = require("fs");
const JSZip = require("jszip");

process.on("unhandledRejection", () => {}); // of its drawing of masks: there is no canvas here
global.window = new JSDOM("", { url: "http://localhost/" }).window;
for (const name of Object.getOwnPropertyNames(window)) if (!(name in global)) global[name] = window[name];
const X3P = require("x3p.js").default;

const points = 256, spacing = 0.5e-6, step = 1e-10, unit = 2e-6;
const [source, target] = process.argv.slice(2);
const npy = readFileSync(source);
const start = 10 + npy.readUInt16LE(8);
const whole = Math.sqrt((npy.length - start) / 8);
const data = Buffer.alloc(2 * points * points);
for (let j = 0; j < points; j++)
    for (let i = 0; i < points; i++)
        data.writeInt16LE(Math.round(npy.readDoubleLE(start + 8 * (j * whole + i)) * unit / step), 2 * (j * points + i));

const axis = (name, kind, increment) =>
    `<${name}><AxisType>${kind}</AxisType><DataType>I</DataType><Increment>${increment}</Increment><Offset>0</Offset></${name}>`;
const zip = new JSZip();
zip.file("bindata/data.bin", data);
zip.file("main.xml",
    `<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1><Revision>ISO5436 - 2000</Revision>` +
    `<FeatureType>SUR</FeatureType><Axes>${axis("CX", "I", spacing)}${axis("CY", "I", spacing)}${axis("CZ", "A", step)}</Axes>` +
    `</Record1><Record2><Creator>nobody</Creator></Record2><Record3><MatrixDimension><SizeX>${points}</SizeX>` +
    `<SizeY>${points}</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>bindata/data.bin</PointDataLink>` +
    `<MD5ChecksumPointData>${createHash("md5").update(data).digest("hex")}</MD5ChecksumPointData></DataLink></Record3>` +
    `<Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4></p:ISO5436_2>`);
(async () => {
    const x3p = await X3P.load({ file: await zip.generateAsync({ type: "uint8array" }), name: "patch" });
    x3p.manifest.set("Record2 Comment", "a corner of the map of recipe.json");
    x3p.saveMask = false;
    await x3p.save();
    writeFileSync(target, await x3p.loader.zip.generateAsync(
        { type: "nodebuffer", compression: "DEFLATE", compressionOptions: { level: 9 } }));
})().catch((fault) => {
    console.error(fault);
    process.exit(1);
});
