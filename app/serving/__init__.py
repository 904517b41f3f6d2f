"""A warm process that renders for others: what `halation serve` does.

Clients send requests as lines of JSON, on standard input or through a local socket, and get a line for each. One thread
renders, because OpenGL draws on the thread that opened it; each client has a thread that reads its lines. The device,
its programs and results stay from request to request, so a small picture takes milliseconds instead of the start of a
process.

- `service_requests` says what a request may ask for, and reads it from a line.
- `request_queue` keeps the requests of all clients and hands them out in turns, one of each client, so that a client
  with a thousand requests does not delay one with a single request.
- `service` answers one request. Between two passes it looks whether the client is still there and the time is not over.
- `listening` reads lines from a stream or from the clients of a socket.

A request may do no more than a command: `--root` holds, code of users is tried in a process of its own first, and the
size of pictures, the length of a line and the number of waiting requests are limited.
"""
