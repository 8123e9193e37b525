// TeX to HTML by KaTeX, ahead of time, so that pages need no script. JSON in: [[tex, display], ...]; out: [html, ...]. A formula that KaTeX
// cannot read ends it with status 1.
const katex = require(process.argv[2]);
const given = JSON.parse(require("fs").readFileSync(0, "utf8"));
const made = given.map(([tex, display]) => {
    try {
        return katex.renderToString(tex, { displayMode: display, throwOnError: true, output: "html", strict: "error" });
    } catch (error) {
        console.error(`${tex}: ${error.message}`);
        process.exit(1);
    }
});
process.stdout.write(JSON.stringify(made));
