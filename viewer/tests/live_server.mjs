// A page and a WebSocket at /live that only sends, as `locograph view --serve` does (RFC 6455).
import { createHash } from 'node:crypto';
import { createServer } from 'node:http';

export async function serveLive(html) {
  const sockets = [];
  let connected;
  const connection = new Promise((resolve) => (connected = resolve));
  const server = createServer((request, response) => {
    response.writeHead(200, { 'content-type': 'text/html' });
    response.end(html);
  });
  server.on('upgrade', (request, socket) => {
    const key = `${request.headers['sec-websocket-key']}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`;
    const accept = createHash('sha1').update(key).digest('base64');
    socket.write(
      'HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n' +
        `Sec-WebSocket-Accept: ${accept}\r\n\r\n`,
    );
    sockets.push(socket);
    connected(request.url);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    address: `http://127.0.0.1:${server.address().port}/`,
    connection,
    send(message) {
      const text = Buffer.from(JSON.stringify(message));
      const head = Buffer.from([0x81, 126, text.length >> 8, text.length & 255]);
      const short = Buffer.from([0x81, text.length]);
      for (const socket of sockets)
        socket.write(Buffer.concat([text.length < 126 ? short : head, text]));
    },
    async close() {
      for (const socket of sockets) socket.destroy();
      await new Promise((resolve) => server.close(resolve));
    },
  };
}
