def insecure_channel(address):
    return address
