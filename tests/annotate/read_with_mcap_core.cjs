// Reads an MCAP file by its index with @mcap/core, CRCs checked, and prints per topic how many messages it has and their bytes.
const { open } = require("node:fs/promises");
const { McapIndexedReader } = require("@mcap/core");
const { FileHandleReadable } = require("@mcap/nodejs");
const { loadDecompressHandlers } = require("@mcap/support");

async function main() {
  const file = await open(process.argv[2], "r");
  const reader = await McapIndexedReader.Initialize({
    readable: new FileHandleReadable(file),
    decompressHandlers: await loadDecompressHandlers(),
  });
  const found = {};
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const { topic } = reader.channelsById.get(message.channelId);
    found[topic] ??= { messages: 0, bytes: 0 };
    found[topic].messages += 1;
    found[topic].bytes += message.data.byteLength;
  }
  await file.close();
  console.log(JSON.stringify(found));
}

main();
